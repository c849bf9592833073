#include "lab/sim/write_log.h"

#include <algorithm>

#include "lab/sim/progress.h"
#include "lab/sim/tum.h"

namespace sim
{

namespace
{

constexpr int32_t smallest_range_mm = 20;

void write_pose(std::FILE *log, const Pose &pose)
{
    std::fprintf(log, " %.6f %.6f %.9f", pose.x, pose.y, wrapped(pose.theta));
}

void write_header(const Scanner &scanner, std::FILE *log)
{
    const double beam_time_us = static_cast<double>(scanner.period_us()) / scanner.turn_steps;
    std::fprintf(log, "# beam_time_us %.5f stamp_beam %d\n", beam_time_us,
                 scanner.front_step - scanner.first_step);
}

void write_scan(WorldSource &source, const Turn &turn, int64_t stamp_us, std::FILE *log)
{
    const Scanner &scanner = source.scanner();
    const int32_t beams = scanner.last_step - scanner.first_step + 1;
    const double step = 2 * pi / scanner.turn_steps;
    std::fprintf(log, "ROBOTLASER1 4 %.9f %.9f %.9f %.3f 0.01 0 %d", scanner.bearing(scanner.first_step),
                 step * (beams - 1), step, scanner.max_mm / 1000.0, beams);
    for (int32_t k = scanner.first_step; k <= scanner.last_step; k++) {
        const int32_t value = turn.value_mm[static_cast<size_t>(k)];
        std::fprintf(log, " %.3f", value < smallest_range_mm ? 0 : value / 1000.0);
    }
    const Pose robot = source.odometry(stamp_us);
    std::fprintf(log, " 0");
    write_pose(log, compose(robot, source.world().sensor));
    write_pose(log, robot);
    const double seconds = static_cast<double>(stamp_us) / 1e6;
    std::fprintf(log, " 0 0 0 0 0 %.6f sim %.6f\n", seconds, seconds);
}

} // namespace

uint32_t write_log(WorldSource &source, std::FILE *log, std::FILE *truth)
{
    const Scanner &scanner = source.scanner();
    Progress progress;
    uint32_t scans = 0;
    write_header(scanner, log);
    while (source.due_us()) {
        const Event event = source.next();
        const auto *turn = std::get_if<Turn>(&event);
        if (!turn) {
            continue;
        }
        const int64_t stamp_us = turn->start_us + scanner.step_time_us(scanner.front_step);
        write_scan(source, *turn, stamp_us, log);
        if (truth) {
            write_tum(truth, stamp_us, source.truth(stamp_us).value_or(Pose{}));
        }
        scans++;
        progress.show(stamp_us, scans);
    }
    return scans;
}

} // namespace sim
