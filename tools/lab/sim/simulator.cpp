#include "lab/sim/simulator.h"

#include <algorithm>
#include <cmath>

#include "lab/sim/device/ldrobot_device.h"
#include "lab/sim/line/pty.h"
#include "lab/sim/line/tcp_port.h"
#include "lab/sim/progress.h"
#include "lab/sim/tum.h"

namespace sim
{

namespace
{

/* From the request that begins the play to the first turn. */
constexpr int64_t run_up_us = 10000;
constexpr int64_t longest_wait_us = 100000;
/* After the last frame the line stays open so long, and longer where the client is still to read: closing it
 * takes away what is not read yet. */
constexpr int64_t farewell_host_us = 500000;
constexpr int64_t longest_farewell_host_us = 10000000;
constexpr int64_t farewell_look_host_us = 50000;

ScipDevice::Options device_options(const SimulatorOptions &options, const Faults &faults, const Clock &clock)
{
    return {options.protocol, options.command_interval_us, faults.wrap_us(), clock.utime(0), options.speed};
}

std::unique_ptr<Device> device_of(const Scanner &scanner, const SimulatorOptions &options,
                                  const Faults &faults, const Clock &clock)
{
    switch (options.family) {
    case SensorFamily::ldrobot:
        return std::make_unique<LdrobotDevice>();
    case SensorFamily::rplidar:
        return std::make_unique<RplidarDevice>(options.rplidar);
    case SensorFamily::urg:
        break;
    }
    return std::make_unique<ScipDevice>(scanner, device_options(options, faults, clock));
}

std::unique_ptr<Port> port_of(const SimulatorOptions &options)
{
    if (options.tcp_port > 0) {
        return std::make_unique<TcpPort>(options.tcp_port);
    }
    return std::make_unique<Pty>(options.link);
}

} // namespace

Simulator::Simulator(Source &source, const SimulatorOptions &options, OdometryOut *odometry, DriveIn *drive,
                     std::FILE *truth)
    : source_(source), odometry_(odometry), drive_(drive), truth_(truth), clock_(options.speed),
      faults_(options.faults, options.seed), device_(device_of(source.scanner(), options, faults_, clock_)),
      port_(port_of(options)), line_(options.baud_limit)
{
}

void Simulator::run(bool (*stop)())
{
    Progress progress;
    while (!stop() && !over_) {
        const int64_t now_us = clock_.now_us();
        end_outage(now_us);
        listen(now_us);
        if (play_start_us_) {
            play(now_us);
            progress.show(now_us - *play_start_us_, tally_.sent);
        }
        line_.pump(*port_, clock_.now_us(), clock_.host_us());
        const int64_t wait_us = std::min(longest_wait_us, next_us(now_us) - clock_.now_us());
        port_->wait(clock_.host_duration_us(wait_us), drive_ ? drive_->descriptor() : -1);
    }
    if (over_) {
        let_client_finish();
    }
}

void Simulator::listen(int64_t now_us)
{
    if (drive_) {
        drive_->receive(play_start_us_ ? now_us - *play_start_us_ : DriveIn::too_early_us);
    }
    const std::string heard = port_->read();
    if (now_us >= outage_until_us_) {
        device_->receive(heard, now_us);
        send(device_->answer(now_us), now_us);
    }
    if (!play_start_us_ && device_->wanted(port_->connected())) {
        play_start_us_ = now_us + run_up_us;
    }
}

void Simulator::play(int64_t now_us)
{
    const int64_t play_us = now_us - *play_start_us_;
    for (const Fault &fault : faults_.due(play_us, static_cast<int64_t>(tally_.scans))) {
        strike(fault, now_us);
    }
    std::optional<int64_t> due_us = source_.due_us();
    while (due_us && *due_us <= play_us) {
        const Event event = source_.next();
        if (const auto *turn = std::get_if<Turn>(&event)) {
            play_turn(*turn, now_us);
        } else if (const auto *sweep = std::get_if<Sweep>(&event)) {
            play_sweep(*sweep, now_us);
        } else if (odometry_) {
            const auto &report = std::get<OdometryReport>(event);
            odometry_->publish(clock_.utime(*play_start_us_ + report.stamp_us), report.pose);
        }
        due_us = source_.due_us();
    }
    over_ = !due_us && !line_.busy();
}

/* Whether what is due now finds no line. Several turns may be due at once: the line takes what waits first.
 */
bool Simulator::is_swallowed(int64_t now_us)
{
    line_.pump(*port_, clock_.now_us(), clock_.host_us());
    return now_us < outage_until_us_ || line_.full();
}

void Simulator::play_turn(const Turn &turn, int64_t now_us)
{
    tally_.scans++;
    if (is_swallowed(now_us)) {
        tally_.swallowed += device_->streaming() ? 1 : 0;
        return;
    }
    send(device_->turn(turn, *play_start_us_ + turn.start_us), now_us);
}

void Simulator::play_sweep(const Sweep &sweep, int64_t now_us)
{
    tally_.scans += sweep.begins_turn ? 1 : 0;
    if (is_swallowed(now_us)) {
        tally_.swallowed += sweep.begins_turn && device_->streaming() ? 1 : 0;
        return;
    }
    send(device_->sweep(sweep, *play_start_us_ + std::llround(sweep.start_us)), now_us);
}

/* On a line of another rate than the device's, the client reads bits where none are. */
std::string Simulator::at_the_clients_rate(const std::string &bytes) const
{
    if (device_->rate() == 0 || port_->rate() == 0 || port_->rate() == device_->rate()) {
        return bytes;
    }
    std::string read;
    for (size_t k = 0; k + 1 < bytes.size(); k += 2) {
        const auto first = static_cast<unsigned char>(bytes[k]);
        const auto second = static_cast<unsigned char>(bytes[k + 1]);
        read += static_cast<char>((static_cast<unsigned>(first) << 1U ^ second) | 0x80U);
    }
    return read;
}

void Simulator::send(const std::vector<Reply> &replies, int64_t now_us)
{
    for (const Reply &reply : replies) {
        if (!reply.measured) {
            line_.send(at_the_clients_rate(reply.bytes));
            continue;
        }
        const auto number = static_cast<int64_t>(tally_.scans) - 1;
        const std::string damaged = faults_.damage(reply.bytes, now_us - *play_start_us_, number);
        tally_.damaged += damaged == reply.bytes ? 0 : 1;
        line_.send(at_the_clients_rate(damaged));
        if (reply.turn_start_us) {
            tally_.sent++;
            write_truth(*reply.turn_start_us);
        }
    }
}

void Simulator::write_truth(int64_t play_us)
{
    const std::optional<Pose> pose = source_.truth(play_us);
    if (truth_ && pose) {
        write_tum(truth_, clock_.utime(*play_start_us_ + play_us), *pose);
    }
}

void Simulator::strike(const Fault &fault, int64_t now_us)
{
    const auto length_us = static_cast<int64_t>(fault.argument * 1e6);
    switch (fault.kind) {
    case FaultKind::silence:
        outage_until_us_ = now_us + length_us;
        line_.drop();
        break;
    case FaultKind::unplug:
        outage_until_us_ = now_us + length_us;
        line_.drop();
        port_->unplug();
        break;
    case FaultKind::reset11:
        line_.drop();
        device_->power_up_in_scip1(now_us);
        break;
    case FaultKind::hardware: {
        const std::string digits = std::to_string(static_cast<int>(fault.argument));
        device_->break_stream(digits.size() < 2 ? "0" + digits : digits);
        break;
    }
    case FaultKind::stall:
        device_->stall(now_us + length_us);
        break;
    default:
        break;
    }
}

void Simulator::end_outage(int64_t now_us)
{
    if (!port_->plugged() && now_us >= outage_until_us_) {
        port_->plug();
        device_->power_up(now_us);
    }
}

int64_t Simulator::next_us(int64_t now_us)
{
    int64_t next = line_.next_us(now_us);
    next = std::min(next, device_->answer_due_us().value_or(INT64_MAX));
    next = outage_until_us_ > now_us ? std::min(next, outage_until_us_) : next;
    if (play_start_us_) {
        const int64_t fault_us = faults_.next_due_us();
        next = std::min(next, *play_start_us_ + source_.due_us().value_or(0));
        next = fault_us == INT64_MAX ? next : std::min(next, *play_start_us_ + fault_us);
    }
    return std::max(next, now_us);
}

void Simulator::let_client_finish()
{
    const int64_t begin_us = clock_.host_us();
    int64_t longest_us = farewell_host_us;
    while (port_->connected() && clock_.host_us() - begin_us < longest_us) {
        port_->read();
        port_->wait(farewell_look_host_us, -1);
        longest_us = port_->client_has_to_read() ? longest_farewell_host_us : farewell_host_us;
    }
}

} // namespace sim
