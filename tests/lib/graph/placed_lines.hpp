// Lines of a synthetic wall as scans at known poses extract them.
#ifndef TESTS_GRAPH_PLACED_LINES_HPP
#define TESTS_GRAPH_PLACED_LINES_HPP

#include "graph/walls/wall_groups.h"

extern "C" {
#include "base/trig.h"
}

namespace placed_lines
{

constexpr int64_t sigma_um = 10000;
constexpr int64_t sigma_urad = 6000;

inline uint32_t bam_of_degrees(double degrees)
{
    return static_cast<uint32_t>(static_cast<int64_t>(degrees * ALE_BAM_PER_DEGREE));
}

// A line on a wall that faces along `normal_deg`, from..to along its tangent, `off_mm` in front of it.
inline ale::PlacedLine line(uint32_t scan, double normal_deg, double from_m, double to_m, double off_mm,
                            double turned_mrad = 0)
{
    ale::PlacedLine placed = {};
    const uint32_t normal_bam = bam_of_degrees(normal_deg);
    const auto half_um = static_cast<int32_t>((to_m - from_m) * 5e5);
    placed.scan = scan;
    placed.line.centre =
        ale_plus(ale_polar(static_cast<int64_t>((from_m + to_m) * 5e5), ale_tangent_bam(normal_bam)),
                 ale_polar(static_cast<int64_t>(off_mm * 1000), normal_bam));
    placed.line.normal_bam =
        normal_bam + static_cast<uint32_t>(static_cast<int64_t>(turned_mrad * ALE_BAM_PER_MRAD));
    placed.line.start_um = -half_um;
    placed.line.end_um = half_um;
    placed.line.var_offset_um2 = 9000000;
    placed.line.var_angle_urad2 = 25000000;
    placed.pose_var_um2 = sigma_um * sigma_um;
    placed.pose_var_urad2 = sigma_urad * sigma_urad;
    return placed;
}

} // namespace placed_lines

#endif
