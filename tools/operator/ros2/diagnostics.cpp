#include "operator/ros2/diagnostics.h"

#include <algorithm>
#include <cstdio>

#include "operator/ros2/geometry.h"

namespace ros2
{

namespace
{

constexpr std::chrono::seconds silence{3};

std::string text(float value)
{
    char out[32];
    std::snprintf(out, sizeof out, "%.1f", static_cast<double>(value));
    return out;
}

Finding tracking_finding(const ale::status_t &status, const ale::tracking_t *tracking)
{
    constexpr int8_t good = 2;
    Finding out{Finding::ok, "ale-slam: tracking", "good", status.device, {}};
    if (status.state != good) {
        out.level = status.state == 1 ? Finding::warn : Finding::error;
        out.message = status.state == 1 ? "weak" : "lost";
    }
    if (tracking && tracking->map_id != 0) {
        out.level = std::max(out.level, Finding::warn);
        out.message += ", in a new map that is not joined yet: no map -> odom";
    }
    if (tracking && tracking->wheel_fault != 0) {
        out.level = std::max(out.level, Finding::warn);
        out.message += ", wheels: " + tracking->wheel_word;
    }
    out.values = {{"robot", status.robot},
                  {"poses", std::to_string(status.poses)},
                  {"maps", std::to_string(tracking ? tracking->maps : 1)},
                  {"exploration", status.exploration},
                  {"who drives", status.who_drives}};
    return out;
}

Finding scanner_finding(const ale::status_t &status)
{
    const bool streaming = status.driver_state.rfind("streaming", 0) == 0;
    Finding out{streaming ? Finding::ok : Finding::error,
                "ale-slam: scanner",
                status.driver_state,
                status.device,
                {}};
    out.values = {{"scans", std::to_string(status.scans)}, {"rate (Hz)", text(status.scan_rate_hz)}};
    const size_t counters = std::min(status.counter_name.size(), status.counter_value.size());
    for (size_t k = 0; k < counters; k++) {
        out.values.emplace_back(status.counter_name[k], std::to_string(status.counter_value[k]));
    }
    return out;
}

Finding time_finding(const ale::status_t &status)
{
    Finding out{status.realtime != 0 ? Finding::ok : Finding::warn,
                "ale-slam: real time",
                status.realtime_detail,
                status.device,
                {}};
    out.values = {{"deadline misses", std::to_string(status.deadline_misses)},
                  {"latency median (us)", text(status.latency_p50_us)},
                  {"latency worst (us)", text(status.latency_worst_us)}};
    return out;
}

Finding commands_finding(const RosCommands &commands, bool has_key)
{
    Finding out{Finding::ok,
                "ale-ros2: commands",
                has_key ? "signed with the bridge's key" : "no key: it only watches",
                "",
                {}};
    for (const RosCommands::Topic &topic : commands.topics()) {
        out.values.emplace_back(std::string(topic.name) + " sent", std::to_string(topic.sent));
        out.values.emplace_back(std::string(topic.name) + " refused", std::to_string(topic.refused));
        if (topic.told) {
            out.level = Finding::warn;
            out.message = std::string(topic.name) + " is refused: " + topic.newest_refusal;
        }
    }
    return out;
}

diagnostic_msgs_msg_dds__DiagnosticStatus_ ros_status(Finding &finding,
                                                      std::vector<diagnostic_msgs_msg_dds__KeyValue_> &values)
{
    for (auto &[key, value] : finding.values) {
        values.push_back({key.data(), value.data()});
    }
    diagnostic_msgs_msg_dds__DiagnosticStatus_ out{};
    out.level = finding.level;
    out.name = finding.name.data();
    out.message = finding.message.data();
    out.hardware_id = finding.hardware.data();
    out.values._length = out.values._maximum = static_cast<uint32_t>(values.size());
    out.values._buffer = values.data();
    return out;
}

} // namespace

std::vector<Finding> findings_of(const ale::status_t &status, const ale::tracking_t *tracking)
{
    return {tracking_finding(status, tracking), scanner_finding(status), time_finding(status)};
}

Diagnostics::Diagnostics(const Participant &participant)
    : writer_(participant, "diagnostics", diagnostic_msgs_msg_dds__DiagnosticArray__desc, Quality::stream, 10)
{
}

void Diagnostics::take(const ale::status_t &status)
{
    status_ = status;
    heard_ = Clock::now();
}

std::vector<Finding> Diagnostics::of_robot() const
{
    if (!status_ || Clock::now() - heard_ > silence) {
        return {{Finding::stale, "ale-slam: tracking", "nothing is heard of the robot", "", {}}};
    }
    return findings_of(*status_, tracking_ ? &*tracking_ : nullptr);
}

void Diagnostics::send(const RosCommands &commands, bool has_key)
{
    std::vector<Finding> findings = of_robot();
    findings.push_back(commands_finding(commands, has_key));
    std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values(findings.size());
    std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> statuses;
    for (size_t k = 0; k < findings.size(); k++) {
        statuses.push_back(ros_status(findings[k], values[k]));
    }
    const int64_t now_us = std::chrono::duration_cast<std::chrono::microseconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
    std::string frame;
    diagnostic_msgs_msg_dds__DiagnosticArray_ out{};
    out.header = {ros_time(status_ ? status_->utime : now_us), frame.data()};
    out.status._length = out.status._maximum = static_cast<uint32_t>(statuses.size());
    out.status._buffer = statuses.data();
    writer_.write(out);
}

} // namespace ros2
