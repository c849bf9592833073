#include "robot/latency/latencies.h"

#include <algorithm>

#include "common/feed/checks.h"

namespace latency
{

namespace
{

constexpr int64_t ns_per_us = 1000;
constexpr int64_t longest_us = 1000LL * 1000 * 1000; /* a quarter of an hour: no scan is older */
constexpr size_t stages = 5;

bool plausible(int64_t span_us)
{
    return span_us >= 0 && span_us < longest_us;
}

void check_times(const ale::pose_t &pose)
{
    feed::check(pose);
    feed::require(pose.utime > 0 && pose.utime < INT64_MAX / 2, "no time of measurement");
    feed::require(plausible(pose.arrival_utime - pose.first_beam_utime),
                  "a scan that arrived before it began");
    feed::require(plausible(pose.utime + pose.age_us - pose.arrival_utime),
                  "a pose that was sent before its scan arrived");
    for (size_t k = 0; k < stages; k++) {
        feed::require(pose.stage_ns[k] >= 0 && pose.stage_start_ns[k] >= 0 &&
                          pose.stage_end_ns[k] >= pose.stage_start_ns[k],
                      "a stage that ended before it began");
    }
}

} // namespace

const std::array<const char *, span_count> span_names = {"sweep", "wait", "deskew", "smooth", "extract",
                                                         "match", "map",  "send",   "in all"};

void Latencies::add(Span span, int64_t time_ns, int32_t scan)
{
    SpanTimes &times = spans_[span];
    if (times.times.count == 0 || time_ns > times.times.worst_ns) {
        times.worst_scan = scan;
    }
    ale_durations_add(&times.times, time_ns);
}

void Latencies::add(const ale::pose_t &pose)
{
    check_times(pose);
    const int64_t whole_ns = (pose.utime + pose.age_us - pose.arrival_utime) * ns_per_us;
    poses_++;
    add(in_all, whole_ns, pose.scan);
    const int32_t ended_ns = *std::max_element(pose.stage_end_ns, pose.stage_end_ns + stages);
    if (pose.predicted || ended_ns == 0) {
        predicted_++;
        return;
    }
    add(sweep, (pose.arrival_utime - pose.first_beam_utime) * ns_per_us, pose.scan);
    add(wait, pose.stage_start_ns[0], pose.scan);
    for (size_t k = 0; k < stages; k++) {
        add(static_cast<Span>(deskew + k), pose.stage_ns[k], pose.scan);
    }
    add(send, std::max<int64_t>(0, whole_ns - ended_ns), pose.scan);
}

} // namespace latency
