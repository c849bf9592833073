/* Where the time of scans goes, from the first beam to the pose on the wire, as the poses themselves say.
 *
 *   first beam ──sweep──► last byte ──wait──► deskew, smooth, extract, match, map ──send──► ALE_POSE
 *                             └──────────────────────── in all ────────────────────────────────┘
 *
 * Stages are in real time; sweep, send and the whole are in the robot's clock, which is real time unless the
 * firmware runs with --time-scale. */
#ifndef LATENCY_LATENCIES_H
#define LATENCY_LATENCIES_H

#include <array>
#include <cstdint>

#include "ale/pose_t.hpp"

extern "C" {
#include "telemetry/durations.h"
}

namespace latency
{

enum Span : size_t { sweep, wait, deskew, smooth, extract, match, map, send, in_all, span_count };

extern const std::array<const char *, span_count> span_names;

struct SpanTimes {
    ale_durations_t times{};
    int32_t worst_scan = 0;
};

class Latencies
{
  public:
    /* Throws std::runtime_error when the message contradicts itself. A predicted pose counts in all only: no
     * stage stood behind it. */
    void add(const ale::pose_t &pose);

    const SpanTimes &operator[](Span span) const
    {
        return spans_[span];
    }
    int64_t poses() const
    {
        return poses_;
    }
    int64_t predicted() const
    {
        return predicted_;
    }

  private:
    void add(Span span, int64_t time_ns, int32_t scan);

    std::array<SpanTimes, span_count> spans_{};
    int64_t poses_ = 0;
    int64_t predicted_ = 0;
};

} // namespace latency

#endif
