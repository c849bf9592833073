#include "lab/replay/summary.h"

#include <cstdio>
#include <set>
#include <unistd.h>

#include "common/export/map_image.h"

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

namespace
{

void print_trouble(const ReplayCounts &counts)
{
    if (counts.maps > 1) {
        std::fprintf(stderr, "ale-replay: after the last scan there were %u maps that are not joined\n",
                     counts.maps);
    }
    if (counts.wheel_faults > 0) {
        std::fprintf(stderr, "ale-replay: the wheels began %u times to contradict the scans\n",
                     counts.wheel_faults);
    }
}

} // namespace

void print_pieces(const ale_map_t &map)
{
    std::set<uint32_t> maps;
    int walls = 0;
    for (int i = 0; i < map.line_count; i++) {
        if (is_apart(map.line[i])) {
            maps.insert(map.line[i].map_id);
            walls++;
        }
    }
    if (walls > 0) {
        std::fprintf(stderr,
                     "ale-replay: %d walls (violet) are in %zu maps that are not joined with the first\n",
                     walls, maps.size());
    }
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
    print_trouble(counts);
    const unsigned long long bad = statistics.bad_lines + statistics.bad_chunks + statistics.times_beyond;
    const unsigned long long too_large = statistics.too_many_beams;
    if (statistics.poses_beyond > 0) {
        std::fprintf(stderr, "ale-replay: %llu poses of the odometry left out; last: %s\n",
                     static_cast<unsigned long long>(statistics.poses_beyond), log.last_error().c_str());
    }
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
    if (loops.joins > 0) {
        std::fprintf(stderr, "ale-replay: %u times a map that was begun anew was joined to an older one\n",
                     loops.joins);
    }
    if (loops.maps > 1) {
        std::fprintf(
            stderr,
            "ale-replay: the way is in %u pieces that were never seen to meet: their places relative "
            "to each other are by the wheels alone\n",
            loops.maps);
    }
}

} // namespace ale
