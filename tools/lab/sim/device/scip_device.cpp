#include "lab/sim/device/scip_device.h"

#include <algorithm>
#include <functional>
#include <map>

extern "C" {
#include "scanner/urg/played.h"
}

namespace sim
{

namespace
{

constexpr size_t longest_line = 80;
constexpr size_t longest_string = 16;
constexpr uint32_t clock_mask = 0xffffff;
constexpr int64_t clock_span_us = 16777216000;
constexpr int32_t factory_baud = 19200;
constexpr int32_t recorded_tick_us = 1; /* 24 bits of them come round in 17 s */
constexpr int64_t slack_ms = 1000;      /* by which a recording's scan may come later than by its stamp */

bool all_of_string_allowed(const std::string &text)
{
    return std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string(" ._+@").find(static_cast<char>(c)) != std::string::npos;
    });
}

} // namespace

ScipDevice::ScipDevice(const Scanner &scanner, const Options &options) : scanner_(scanner), options_(options)
{
    power_up(0);
}

void ScipDevice::power_up(int64_t now_us)
{
    boot(options_.protocol == Protocol::scip2 ? ALE_SCIP_2 : ALE_SCIP_1, now_us);
}

void ScipDevice::power_up_in_scip1(int64_t now_us)
{
    boot(ALE_SCIP_1, now_us);
}

void ScipDevice::boot(int protocol, int64_t now_us)
{
    protocol_ = protocol;
    now_us_ = now_us;
    set_laser(false);
    set_laser(protocol == ALE_SCIP_1); /* in 1.1 it measures from power-up */
    time_mode_ = false;
    baud_ = factory_baud;
    stream_.reset();
    waiting_.reset();
    broken_status_.clear();
    line_.clear();
    line_too_long_ = false;
    commands_.clear();
    next_answer_us_ = now_us;
    /* A counter that has yet to wrap stands for a device that has been on for hours. */
    const bool wrap_ahead = options_.clock_wraps_us && now_us < *options_.clock_wraps_us;
    clock_origin_us_ = wrap_ahead ? *options_.clock_wraps_us - clock_span_us : now_us;
}

/* The turn under way when the laser comes on is not a whole measurement. */
void ScipDevice::set_laser(bool on)
{
    if (on != laser_) {
        laser_since_us_ = now_us_;
        last_turn_.reset();
    }
    laser_ = on;
}

uint32_t ScipDevice::clock_ms(int64_t at_us) const
{
    const int64_t since_us = std::max<int64_t>(0, at_us - clock_origin_us_);
    return static_cast<uint32_t>(since_us / 1000) & clock_mask;
}

/* A recording's stamps count in finer ticks and from time 0 of now_us, whatever happens to the device. */
uint32_t ScipDevice::stamp_of(const Turn &turn, int64_t device_start_us) const
{
    if (!scanner_.recorded) {
        return clock_ms(device_start_us);
    }
    const int64_t at_us = device_start_us - turn.start_us + turn.recorded_us;
    return static_cast<uint32_t>(at_us / recorded_tick_us) & clock_mask;
}

std::string ScipDevice::played() const
{
    const Recorded &recorded = *scanner_.recorded;
    const auto host_slack_ms = static_cast<int64_t>(static_cast<double>(slack_ms) * options_.speed);
    ale_urg_played_t played = {};
    played.silence_ms = static_cast<int32_t>(recorded.longest_gap_us / 1000 + slack_ms + host_slack_ms);
    played.zero_us = options_.utime_zero_us;
    played.tick_us = recorded_tick_us;
    played.stamp_step = recorded.stamp_step;
    played.step_ns = recorded.step_ns;
    played.origin_bam = recorded.origin_bam;
    played.step_bam = recorded.step_bam;
    played.blind_before = recorded.blind_before;
    played.blind_from = recorded.blind_from;
    char text[ALE_URG_PLAYED_TEXT];
    ale_urg_played_format(&played, text);
    return text;
}

void ScipDevice::receive(std::string_view bytes, int64_t now_us)
{
    for (const char c : bytes) {
        if (c != '\n' && c != '\r') {
            line_too_long_ = line_too_long_ || line_.size() >= longest_line;
            if (!line_too_long_) {
                line_.push_back(c);
            }
            continue;
        }
        if (!line_.empty()) {
            if (commands_.empty()) {
                next_answer_us_ = std::max(next_answer_us_, now_us);
            }
            commands_.push_back(line_);
        }
        line_.clear();
        line_too_long_ = false;
    }
}

std::optional<int64_t> ScipDevice::answer_due_us() const
{
    return commands_.empty() || waiting_ ? std::nullopt : std::optional(next_answer_us_);
}

std::vector<Reply> ScipDevice::answer(int64_t now_us)
{
    std::vector<Reply> replies;
    now_us_ = now_us;
    while (!commands_.empty() && !waiting_ && next_answer_us_ <= now_us) {
        const std::string line = commands_.front();
        commands_.pop_front();
        replies.push_back(execute(line));
        next_answer_us_ = now_us + options_.command_interval_us;
    }
    return replies;
}

std::vector<Reply> ScipDevice::turn(const Turn &turn, int64_t device_start_us)
{
    if (!laser_ || device_start_us < laser_since_us_) {
        return {};
    }
    last_turn_ = turn;
    last_stamp_ = stamp_of(turn, device_start_us);
    std::vector<Reply> replies;
    if (waiting_) {
        const Waiting waiting = *waiting_;
        waiting_.reset();
        replies.push_back(last_ranges(waiting.request, waiting.echo));
    }
    if (stream_ && stream_->to_skip > 0) {
        stream_->to_skip--;
    } else if (stream_) {
        replies.push_back(stream_frame());
    }
    return replies;
}

Reply ScipDevice::stream_frame()
{
    ale_scip_request_t &request = stream_->request;
    const bool counted = request.scans > 0;
    request.scans = static_cast<uint8_t>(counted ? request.scans - 1 : 0);
    stream_->to_skip = request.skip;
    char text[ALE_SCIP_REQUEST_TEXT];
    ale_scip_request_format(&request, text);
    const std::string echo = text + stream_->suffix;
    Reply out = broken_status_.empty() ? ranges(request, echo, "99") : short_reply(echo, broken_status_);
    if ((counted && request.scans == 0) || !broken_status_.empty()) {
        stream_.reset();
        set_laser(false);
        broken_status_.clear();
    }
    return out;
}

void ScipDevice::break_stream(const std::string &status)
{
    broken_status_ = status;
}

Reply ScipDevice::ranges(const ale_scip_request_t &request, const std::string &echo, const char *status) const
{
    std::vector<int32_t> values;
    const int32_t cluster = std::max<int32_t>(1, request.cluster);
    for (int32_t first = request.first_step; first <= request.last_step; first += cluster) {
        const int32_t end = std::min<int32_t>(first + cluster, request.last_step + 1);
        int32_t nearest = last_turn_->value_mm[static_cast<size_t>(first)];
        for (int32_t step = first + 1; step < end; step++) {
            const int32_t value = last_turn_->value_mm[static_cast<size_t>(step)];
            const bool better = nearest < scanner_.min_mm || value < nearest;
            nearest = value >= scanner_.min_mm && better ? value : nearest;
        }
        values.push_back(nearest);
    }
    ReplyWriter writer(echo, status);
    if (request.protocol == ALE_SCIP_2) {
        writer.stamp(last_stamp_);
    }
    return writer.values(request.protocol, values, request.characters).reply(last_turn_->start_us);
}

Reply ScipDevice::execute(const std::string &line)
{
    if (protocol_ == ALE_SCIP_1) {
        return execute_scip1(line);
    }
    const size_t separator = line.find(';');
    if (separator != std::string::npos) {
        const std::string text = line.substr(separator + 1);
        if (text.size() > longest_string) {
            return short_reply(line, "0G");
        }
        if (!all_of_string_allowed(text)) {
            return short_reply(line, "0H");
        }
    }
    return execute_scip2(line);
}

Reply ScipDevice::execute_scip2(const std::string &line)
{
    const std::string command = scip_command(line);
    const std::string symbol = command.substr(0, 2);
    if (command == "%ST" && scanner_.tells_state) {
        return state(line);
    }
    if (time_mode_ && symbol != "TM") {
        return short_reply(line, "0E");
    }
    using Answer = std::function<Reply(ScipDevice &, const std::string &echo)>;
    static const std::map<std::string, Answer> with_parameter = {
        {"TM", &ScipDevice::time_mode},   {"SS", &ScipDevice::set_baud}, {"CR", &ScipDevice::motor_speed},
        {"HS", &ScipDevice::sensitivity}, {"MD", &ScipDevice::measure},  {"MS", &ScipDevice::measure},
        {"GD", &ScipDevice::measure},     {"GS", &ScipDevice::measure}};
    static const std::map<std::string, Answer> alone = {
        {"VV", &ScipDevice::identity}, {"PP", &ScipDevice::parameters}, {"II", &ScipDevice::condition},
        {"BM", &ScipDevice::laser_on}, {"QT", &ScipDevice::laser_off},  {"RS", &ScipDevice::reset},
        {"RT", &ScipDevice::reset}};
    if (const auto known = with_parameter.find(symbol); known != with_parameter.end()) {
        return known->second(*this, line);
    }
    if (const auto known = alone.find(command); known != alone.end()) {
        return known->second(*this, line);
    }
    return short_reply(line, "0E");
}

Reply ScipDevice::laser_on(const std::string &echo)
{
    const bool was_on = laser_;
    set_laser(true);
    return short_reply(echo, was_on ? "02" : "00");
}

Reply ScipDevice::laser_off(const std::string &echo)
{
    set_laser(false);
    stream_.reset();
    return short_reply(echo, "00");
}

Reply ScipDevice::reset(const std::string &echo)
{
    const int32_t baud = baud_;
    const std::deque<std::string> later = commands_;
    boot(ALE_SCIP_2, now_us_);
    commands_ = later;
    baud_ = scip_command(echo) == "RT" ? baud : baud_;
    return short_reply(echo, "00");
}

Reply ScipDevice::time_mode(const std::string &echo)
{
    const std::string parameter = scip_parameter(echo);
    if (parameter == "0") {
        const bool was_in = time_mode_;
        time_mode_ = true;
        set_laser(false);
        stream_.reset();
        return short_reply(echo, was_in ? "02" : "00");
    }
    if (parameter == "1") {
        return time_mode_ ? ReplyWriter(echo, "00").stamp(clock_ms(now_us_)).reply()
                          : short_reply(echo, "04");
    }
    if (parameter == "2") {
        const bool was_in = time_mode_;
        time_mode_ = false;
        return short_reply(echo, was_in ? "00" : "03");
    }
    return short_reply(echo, parameter.empty() ? "0C" : "01");
}

Reply ScipDevice::measure(const std::string &echo)
{
    const std::string command = scip_command(echo);
    const std::string error = range_error(command);
    if (!error.empty()) {
        return short_reply(echo, error);
    }
    ale_scip_request_t request = {};
    ale_scip_request_parse(reinterpret_cast<const uint8_t *>(command.data()), command.size(), &request);
    if (request.stream) {
        if (stream_) {
            return short_reply(echo, "0B");
        }
        stream_ = Stream{request, echo.substr(command.size()), 0};
        set_laser(true);
        wanted_ = true;
        return short_reply(echo, "00");
    }
    if (!laser_) {
        return short_reply(echo, "10");
    }
    return last_ranges(request, echo);
}

/* The reply with the last turn's ranges; empty when the first turn has to be waited for. */
Reply ScipDevice::last_ranges(const ale_scip_request_t &request, const std::string &echo)
{
    wanted_ = true;
    if (!last_turn_) {
        waiting_ = Waiting{request, echo};
        return {};
    }
    return ranges(request, echo, request.protocol == ALE_SCIP_1 ? "0" : "00");
}

} // namespace sim
