#include "robot/latency/report.h"

#include <cstdio>

#include "common/export/formatted.h"

namespace latency
{

namespace
{

constexpr uint32_t octaves = 43;
constexpr uint32_t first_octave = 9; /* all below a microsecond is one row */

double microseconds(int64_t time_ns)
{
    return static_cast<double>(time_ns) * 1e-3;
}

std::string quantiles(const Latencies &latencies)
{
    std::string text = "microseconds      scans    median       p99     worst  at scan\n";
    for (size_t k = 0; k < span_count; k++) {
        const SpanTimes &span = latencies[static_cast<Span>(k)];
        text += ale::formatted("%-12s %10u %9.1f %9.1f %9.1f %8d\n", span_names[k], span.times.count,
                               microseconds(ale_durations_quantile(&span.times, 500)),
                               microseconds(ale_durations_quantile(&span.times, 990)),
                               microseconds(span.times.worst_ns), span.worst_scan);
    }
    return text;
}

uint32_t count_in_row(const Latencies &latencies, size_t span, uint32_t octave)
{
    const ale_durations_t &times = latencies[static_cast<Span>(span)].times;
    uint32_t count = ale_durations_octave(&times, octave);
    for (uint32_t below = 0; octave == first_octave && below < first_octave; below++) {
        count += ale_durations_octave(&times, below);
    }
    return count;
}

bool anything_in(const Latencies &latencies, uint32_t octave)
{
    for (size_t k = 0; k < span_count; k++) {
        if (count_in_row(latencies, k, octave) > 0) {
            return true;
        }
    }
    return false;
}

std::string histogram_row(const Latencies &latencies, uint32_t octave)
{
    std::string row = ale::formatted("%12.1f", microseconds(int64_t{2} << octave));
    for (size_t k = 0; k < span_count; k++) {
        const uint32_t count = count_in_row(latencies, k, octave);
        row += count > 0 ? ale::formatted(" %8u", count) : ale::formatted(" %8s", ".");
    }
    return row + "\n";
}

std::string histogram(const Latencies &latencies)
{
    uint32_t first = first_octave;
    uint32_t last = octaves;
    while (first < octaves && !anything_in(latencies, first)) {
        first++;
    }
    while (last > first && !anything_in(latencies, last - 1)) {
        last--;
    }
    std::string text = "       up to";
    for (const char *name : span_names) {
        text += ale::formatted(" %8s", name);
    }
    text += "\n";
    for (uint32_t octave = first; octave < last; octave++) {
        text += histogram_row(latencies, octave);
    }
    return text;
}

} // namespace

std::string report(const Latencies &latencies)
{
    return ale::formatted("poses %lld, of them predicted %lld\n", static_cast<long long>(latencies.poses()),
                          static_cast<long long>(latencies.predicted())) +
           quantiles(latencies) + "\n" + histogram(latencies);
}

} // namespace latency
