/* ale-watch: what the robot publishes, as one line a second or as a text screen, and as files at the end. */
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line/files.h"
#include "common/command_line/interrupt.h"
#include "common/command_line/robot_files.h"
#include "common/feed/lcm_feed.h"
#include "operator/watch/live_screen.h"
#include "operator/watch/record.h"
#include "operator/watch/report.h"

namespace
{

constexpr char usage[] =
    "usage: ale-watch [--screen | --once] [--lcm-url URL] [--map FILE]... [--trajectory F.tum] [--csv "
    "F.csv]\n"
    "                 [--seconds N] [--until-silent S]\n"
    "Watches the robot over LCM: one status line a second on stdout, files when it ends.\n"
    "  --screen          state and map as a text screen; keys: f follow the robot, 0 whole map, + - zoom, q "
    "quit\n"
    "  --once            waits for pose, status and map, prints one such screen on stdout and ends\n"
    "  --lcm-url URL     where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --map FILE        map and trajectory as a picture: .png or .svg; may be given several times\n"
    "  --trajectory F    map pose of every scan as it was published, TUM format\n"
    "  --csv F           one row a pose: state, poses, features, times\n"
    "  --seconds N       ends after N seconds\n"
    "  --until-silent S  ends when no pose has come for S seconds (after the first one)\n"
    "  --help, --version\n"
    "Ends also with Ctrl-C or SIGTERM. Exit 1 when no pose came (--once: within 10 s), a file could not be\n"
    "written, or --screen has no terminal.\n";

constexpr char screen_usage[] =
    "usage: ale-screen [--lcm-url URL] [--once]\n"
    "The older name of \"ale-watch --screen\"; it takes all options of ale-watch.\n"
    "  --lcm-url URL  where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --once         waits for pose, status and map, prints one screen on stdout and ends\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed (no terminal, no route for multicast; --once: no pose in 10 s), 2 wrong use.\n";

using Clock = std::chrono::steady_clock;

struct Options {
    bool screen = false;
    bool once = false;
    std::string lcm_url;
    std::vector<std::string> maps;
    std::string trajectory;
    std::string csv;
    double seconds = 0;
    double until_silent_s = 0;

    bool want_files() const
    {
        return !maps.empty() || !trajectory.empty() || !csv.empty();
    }
};

/* Listens until one of the ends that the options name, or a signal. */
class Listener
{
  public:
    Listener(const Options &options, feed::LcmFeed &feed, watch::Record &record)
        : options_(options), feed_(feed), record_(record)
    {
    }

    /* Waits for a message, but not long. False at the end. */
    bool listen()
    {
        if (over_ || cli::interrupted()) {
            return false;
        }
        const int64_t poses = record_.counts().received;
        feed_.wait(50);
        now_ = Clock::now();
        if (record_.counts().received != poses) {
            last_pose_ = now_;
        }
        record_.set_malformed(feed_.refused());
        const bool silent =
            options_.until_silent_s > 0 && record_.newest().pose && silent_s() >= options_.until_silent_s;
        over_ = silent || (options_.seconds > 0 && elapsed_s() >= options_.seconds);
        return true;
    }

    double elapsed_s() const
    {
        return std::chrono::duration<double>(now_ - start_).count();
    }
    double silent_s() const
    {
        return std::chrono::duration<double>(now_ - last_pose_).count();
    }

  private:
    const Options &options_;
    feed::LcmFeed &feed_;
    watch::Record &record_;
    const Clock::time_point start_ = Clock::now();
    Clock::time_point now_ = start_;
    Clock::time_point last_pose_ = start_;
    bool over_ = false;
};

void print_lines(Listener &listener, const watch::Record &record)
{
    std::fputs("ale-watch: listening\n", stderr);
    for (int lines = 0; listener.listen();) {
        if (listener.elapsed_s() >= lines + 1) {
            lines = static_cast<int>(listener.elapsed_s());
            std::printf("%s\n", status_line(record, listener.elapsed_s(), listener.silent_s()).c_str());
            std::fflush(stdout);
        }
    }
}

void show_screen(Listener &listener, const watch::Record &record)
{
    constexpr double frame_s = 0.1;
    watch::LiveScreen screen;
    double next_s = 0;
    do {
        if (listener.elapsed_s() >= next_s) {
            next_s = listener.elapsed_s() + frame_s;
            if (!screen.show(record.newest())) {
                return;
            }
        }
    } while (listener.listen());
}

void print_screen(Listener &listener, const watch::Record &record)
{
    constexpr double longest_s = 10;
    const watch::RobotState &robot = record.newest();
    while (!(robot.pose && robot.status && robot.map.num_lines > 0) && listener.elapsed_s() < longest_s &&
           listener.listen()) {
    }
    if (!robot.pose) {
        throw std::runtime_error("no robot heard");
    }
    std::fputs(printed_screen(robot).c_str(), stdout);
}

void check_files(const Options &options)
{
    cli::Files files;
    files.writes("--trajectory", options.trajectory);
    files.writes("--csv", options.csv);
    for (const std::string &path : options.maps) {
        files.writes("--map", path);
    }
}

void write_files(const Options &options, const watch::Record &record)
{
    if (!options.trajectory.empty()) {
        write_trajectory(record, options.trajectory);
    }
    if (!options.csv.empty()) {
        write_csv(record, options.csv);
    }
    for (const std::string &path : options.maps) {
        write_picture(record, path);
    }
}

void watch_robot(const Options &options, feed::LcmFeed &feed, watch::Record &record)
{
    Listener listener(options, feed, record);
    if (options.once) {
        print_screen(listener, record);
    } else if (options.screen) {
        show_screen(listener, record);
    } else {
        print_lines(listener, record);
    }
    /* What is already here when a signal comes is taken along. */
    if (cli::interrupted()) {
        feed.drain();
    }
    record.set_malformed(feed.refused());
}

void run(const Options &options)
{
    check_files(options);
    feed::LcmFeed feed(options.lcm_url);
    watch::Record record(options.want_files());
    record.subscribe(feed);
    watch_robot(options, feed, record);
    const bool lines = !options.screen && !options.once;
    if (lines) {
        std::printf("%s\n", summary_line(record).c_str());
    }
    if (!record.newest().pose && (lines || options.want_files())) {
        throw std::runtime_error("no pose came: is ale-slamd running, and on the same LCM URL?");
    }
    write_files(options, record);
}

} // namespace

int main(int argc, char **argv)
{
    constexpr double shortest_s = 0.001;
    constexpr double longest_s = 1e9;
    Options options;
    options.screen = std::filesystem::path(argv[0]).filename() == "ale-screen";
    cli::CommandLine line(options.screen ? "ale-screen" : "ale-watch", options.screen ? screen_usage : usage);
    line.flag("screen", options.screen);
    line.flag("once", options.once);
    line.text("lcm-url", options.lcm_url);
    cli::map_images(line, options.maps);
    line.text("trajectory", options.trajectory);
    line.text("csv", options.csv);
    line.number("seconds", options.seconds, shortest_s, longest_s);
    line.number("until-silent", options.until_silent_s, shortest_s, longest_s);
    return line.run(argc, argv, [&] {
        cli::catch_interrupts();
        run(options);
    });
}
