/* ale-odometry: ticks of two wheels from a board's serial line, as ALE_ODOMETRY. */
#include <array>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "robot/odometry/tick_line.h"
#include "robot/odometry/wheel_path.h"

extern "C" {
#include "lcm/bus.h"
#include "serial/port.h"
}

namespace
{

constexpr char usage[] =
    "usage: ale-odometry --port DEV --left TICKS --right TICKS --track METRES [--baud N] [--lcm-url URL]\n"
    "Reads the ticks of two wheels from a board on a serial line and publishes where they took the robot.\n"
    "  --port DEV      serial device of the board; waited for where it is not there, or gone\n"
    "  --left TICKS    ticks of the left wheel in a metre; negative: it counts backwards\n"
    "  --right TICKS   the same of the right one\n"
    "  --track METRES  from wheel to wheel, where they touch the ground\n"
    "  --baud N        rate of the line (default 115200; USB boards take any)\n"
    "  --lcm-url URL   where ALE_ODOMETRY goes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --help, --version\n"
    "The board says, 20 times a second or more: $TICKS,LEFT,RIGHT,MICROS*CRC\n"
    "both counters and its clock since its start, all of 32 bits, and CRC-16/CCITT-FALSE in hex of what "
    "stands\n"
    "between $ and *. \"ale-calibrate wheels --live\" says on a first drive whether it is right.\n"
    "Ends with Ctrl-C or SIGTERM and says what came. Exit: 0 fine, 1 failed, 2 wrong use.\n";

struct Options {
    std::string port;
    std::string lcm_url;
    int baud = 115200;
    odometry::Wheels wheels = {0, 0, 0};
};

struct Closer {
    void operator()(ale_bus_t *bus) const
    {
        ale_bus_close(bus);
    }
    void operator()(ale_port_t *port) const
    {
        ale_port_close(port);
    }
};

int64_t steady_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

int64_t utime_of(int64_t steady)
{
    const int64_t now = std::chrono::duration_cast<std::chrono::microseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count();
    return now - (steady_us() - steady);
}

ale_pose_t core_pose(const odometry::PathPose &pose)
{
    constexpr double bam_per_turn = 4294967296.0;
    const double turns = pose.theta_rad / 6.283185307179586;
    return {static_cast<int32_t>(std::llround(pose.x_m * 1e6)),
            static_cast<int32_t>(std::llround(pose.y_m * 1e6)),
            static_cast<uint32_t>(
                static_cast<int64_t>(std::llround((turns - std::floor(turns)) * bam_per_turn)))};
}

class Sender
{
  public:
    explicit Sender(const Options &options) : options_(options), path_(options.wheels)
    {
        char error[ALE_BUS_ERROR];
        bus_.reset(ale_bus_open_early(options.lcm_url.c_str(), "", error));
        if (!bus_) {
            throw std::runtime_error(error);
        }
    }

    void run()
    {
        while (!cli::interrupted()) {
            if (port_ || open()) {
                read();
            }
            tell_silence();
            ale_bus_tend(bus_.get());
        }
    }

    void tell_all() const
    {
        std::printf("%" PRIu64 " lines, %" PRIu64 " that were none, the board began %" PRIu64 " times\n",
                    lines_.taken(), lines_.refused(), path_.starts());
    }

  private:
    static constexpr int step_ms = 100;
    static constexpr int again_ms = 1000;
    static constexpr int64_t silence_us = 2000000;

    void say(const std::string &text)
    {
        if (text != said_) {
            std::fprintf(stderr, "ale-odometry: %s: %s\n", options_.port.c_str(), text.c_str());
            said_ = text;
        }
    }

    bool open()
    {
        ale_port_t *port = nullptr;
        const int status = ale_port_open(&port, options_.port.c_str(), options_.baud);
        port_.reset(port);
        if (status == ALE_PORT_OK) {
            heard_us_ = steady_us();
            say("open, waits for ticks");
            return true;
        }
        if (status != ALE_PORT_ABSENT && status != ALE_PORT_GONE) {
            throw std::runtime_error(options_.port + ": " + ale_port_strerror(status));
        }
        say(std::string(ale_port_strerror(status)) + "; tried again every second");
        ale_port_wait(nullptr, again_ms);
        return false;
    }

    void read()
    {
        std::array<uint8_t, 512> bytes;
        const int ready = ale_port_wait(port_.get(), step_ms);
        const int count = ready > 0 ? ale_port_read(port_.get(), bytes.data(), bytes.size()) : ready;
        if (count < 0) {
            port_.reset();
            return;
        }
        for (int k = 0; k < count; k++) {
            if (const auto ticks = lines_.take(static_cast<char>(bytes[static_cast<size_t>(k)]))) {
                send(*ticks);
            }
        }
    }

    void send(const odometry::Ticks &ticks)
    {
        heard_us_ = steady_us();
        say("ticks come");
        if (path_.add(ticks, heard_us_)) {
            const ale_odometry_t sample = {utime_of(path_.stamp_us()), core_pose(path_.pose())};
            ale_bus_send_odometry(bus_.get(), &sample);
        }
    }

    void tell_silence()
    {
        if (port_ && steady_us() - heard_us_ > silence_us) {
            say(lines_.refused() > refused_before_
                    ? "no ticks in what comes: \"" + lines_.strange() + "\" (is it the rate, --baud?)"
                    : "nothing comes");
            refused_before_ = lines_.refused();
            heard_us_ = steady_us();
        }
    }

    Options options_;
    odometry::WheelPath path_;
    odometry::TickLines lines_;
    std::unique_ptr<ale_bus_t, Closer> bus_;
    std::unique_ptr<ale_port_t, Closer> port_;
    int64_t heard_us_ = 0;
    uint64_t refused_before_ = 0;
    std::string said_;
};

void check(const Options &options)
{
    if (options.port.empty()) {
        throw cli::WrongUse("--port DEV is missing");
    }
    if (options.wheels.left_per_metre == 0 || options.wheels.right_per_metre == 0 ||
        options.wheels.track_m == 0) {
        throw cli::WrongUse("--left TICKS, --right TICKS and --track METRES are needed, and none is 0");
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-odometry", usage);
    line.text("port", options.port);
    line.text("lcm-url", options.lcm_url);
    line.number("baud", options.baud, 300, 4000000);
    line.number("left", options.wheels.left_per_metre, -1e8, 1e8);
    line.number("right", options.wheels.right_per_metre, -1e8, 1e8);
    line.number("track", options.wheels.track_m, 0.01, 10.0);
    return line.run(argc, argv, [&] {
        check(options);
        cli::catch_interrupts();
        Sender sender(options);
        sender.run();
        sender.tell_all();
    });
}
