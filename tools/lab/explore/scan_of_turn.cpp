#include "lab/explore/scan_of_turn.h"

namespace explore
{

namespace
{

constexpr uint32_t step_bam = UINT32_C(1) << 22;

} // namespace

ale_scan_t scan_of_turn(const sim::Turn &turn, const sim::Scanner &scanner)
{
    ale_scan_t scan = {};
    scan.stamp_us = turn.start_us;
    scan.stamp_beam = -scanner.first_step;
    scan.beam_time_ns = static_cast<int32_t>(scanner.period_us() * 1000 / scanner.turn_steps);
    scan.first_bearing_bam = static_cast<uint32_t>(scanner.first_step - scanner.front_step) * step_bam;
    scan.step_bam = static_cast<int32_t>(step_bam);
    scan.range_min_um = scanner.min_mm * 1000;
    scan.range_max_um = scanner.max_mm * 1000;
    scan.beams = static_cast<uint16_t>(scanner.last_step - scanner.first_step + 1);
    for (uint16_t k = 0; k < scan.beams; k++) {
        ale_scan_set_urg(&scan, k, turn.value_mm[static_cast<size_t>(scanner.first_step) + k]);
    }
    return scan;
}

} // namespace explore
