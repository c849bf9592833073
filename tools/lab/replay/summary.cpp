#include "lab/replay/summary.h"

#include <cstdio>
#include <unistd.h>

namespace ale
{

namespace
{

constexpr auto patience = std::chrono::seconds(2);
constexpr auto refresh = std::chrono::milliseconds(200);
constexpr int bar_width = 40;

} // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1), next_(Clock::now() + patience)
{
}

Progress::~Progress()
{
    if (shown_) {
        std::fputs("\r\033[K", stderr);
    }
}

void Progress::show(const LogReader &log)
{
    if (!terminal_ || Clock::now() < next_) {
        return;
    }
    const ale_log_statistics_t statistics = log.statistics();
    const uint64_t total = statistics.bytes_total ? statistics.bytes_total : 1;
    const int filled = static_cast<int>(statistics.bytes_read * bar_width / total);
    std::fprintf(stderr, "\r[%.*s%*s] %3d %%", filled, "########################################",
                 bar_width - filled, "", static_cast<int>(statistics.bytes_read * 100 / total));
    shown_ = true;
    next_ = Clock::now() + refresh;
}

void print_summary(const std::string &path, const LogReader &log, const ReplayCounts &counts)
{
    const ale_log_statistics_t statistics = log.statistics();
    const auto scans = static_cast<double>(counts.scans);
    std::fprintf(
        stderr,
        "%s: %s, %llu scans, %llu dropped, %.1f lines and %.1f corners a scan, %.3f ms a scan (worst %.3f)\n",
        path.c_str(), log.info().format, static_cast<unsigned long long>(counts.scans),
        static_cast<unsigned long long>(counts.dropped), static_cast<double>(counts.lines) / scans,
        static_cast<double>(counts.corners) / scans, static_cast<double>(counts.cpu_ns) * 1e-6 / scans,
        static_cast<double>(counts.worst_ns) * 1e-6);
    if (counts.lost + counts.weak > 0) {
        std::fprintf(stderr, "ale-replay: the robot was lost in %llu scans, its pose weak in %llu\n",
                     static_cast<unsigned long long>(counts.lost),
                     static_cast<unsigned long long>(counts.weak));
    }
    const unsigned long long bad = statistics.bad_lines + statistics.bad_chunks;
    const unsigned long long too_large = statistics.too_many_beams;
    if (bad + too_large > 0) {
        std::fprintf(
            stderr,
            "ale-replay: skipped %llu bad lines or chunks and %llu scans of too many beams; last: %s\n", bad,
            too_large, log.last_error().c_str());
    }
    if (statistics.cut_short) {
        std::fprintf(stderr,
                     "ale-replay: %s: the packed file is cut short or damaged; read what came before\n",
                     path.c_str());
    }
}

void print_loops(const ale_mapper_statistics_t &loops, int64_t longest_ns)
{
    if (loops.candidates > 0) {
        std::fprintf(
            stderr,
            "ale-replay: loops: %u closed, %u undone; of %u places seen again %u known, %u unclear; %u "
            "keyframes, longest correction %.1f ms\n",
            loops.loops, loops.contradicted, loops.candidates, loops.recognised, loops.unclear,
            loops.keyframes, static_cast<double>(longest_ns) * 1e-6);
    }
}

} // namespace ale
