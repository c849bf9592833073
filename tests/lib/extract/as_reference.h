// The extractor's working memory in the twins' units, so that a stage and its twin see the same.
#ifndef ALE_TESTS_LIB_EXTRACT_AS_REFERENCE_H
#define ALE_TESTS_LIB_EXTRACT_AS_REFERENCE_H

#include <cmath>
#include <vector>

#include "reference/scan_points.h"

extern "C" {
#include "extract/workspace.h"
}

namespace scene
{

inline reference::ScanPoints points_of(const ale_extractor_t &e)
{
    reference::ScanPoints points;
    for (int i = 0; i < e.count; i++) {
        points.push_back({e.beam[i], e.range_um[i] / 1000.0, e.x_q4[i] / 16.0, e.y_q4[i] / 16.0});
    }
    return points;
}

// The valid beams of a scan; where they lie is for the twin to find.
inline reference::ScanPoints points_of(const ale_scan_t &scan)
{
    reference::ScanPoints points;
    for (int k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID) {
            points.push_back({k, scan.range_um[k] / 1000.0, 0, 0});
        }
    }
    return points;
}

// Of an angle or bearing, within half a turn.
inline double radians(uint32_t angle_bam)
{
    return std::ldexp(static_cast<int32_t>(angle_bam), -31) * 3.14159265358979323846;
}

inline double step_of(const ale_scan_t &scan)
{
    return std::fabs(radians(static_cast<uint32_t>(scan.step_bam)));
}

inline reference::NoiseOfScan noise_of(const ale_extractor_t &e)
{
    const double q36 = std::ldexp(1.0, -36);
    return {static_cast<double>(e.noise.own_mm2_q36) * q36,
            static_cast<double>(e.noise.own_relative_q36) * q36,
            static_cast<double>(e.noise.own_scale_q16) / 65536,
            static_cast<double>(e.noise.shared_mm2_q36) * q36,
            static_cast<double>(e.noise.shared_relative_q36) * q36,
            static_cast<double>(e.config.noise.shared_beams),
            static_cast<double>(e.noise.bearing_rad2_q36) * q36,
            e.shared_scale_q8 > 256
                ? static_cast<double>(e.shared_stated_q8) / static_cast<double>(e.shared_scale_q8)
                : 1,
            e.shared_absent,
            e.shared_scale_q8 > 256,
            e.unruly,
            ale_costly(&e)};
}

inline reference::NoiseOfScan noise_of(const ale_noise_t &n)
{
    const auto square = [](double v) { return v * v; };
    return {square(n.own_um * 1e-3),      square(n.own_ppm * 1e-6),    1,
            square(n.shared_um * 1e-3),   square(n.shared_ppm * 1e-6), static_cast<double>(n.shared_beams),
            square(n.bearing_nrad * 1e-9)};
}

inline std::vector<reference::Run> segments_of(const ale_extractor_t &e)
{
    std::vector<reference::Run> segments;
    for (int k = 0; k < e.segment_count; k++) {
        segments.push_back({e.segment[k].first, e.segment[k].last});
    }
    return segments;
}

inline std::vector<reference::Run> runs_of(const ale_extractor_t &e)
{
    std::vector<reference::Run> runs;
    for (int k = 0; k < e.run_count; k++) {
        const ale_run_t &run = e.run[k];
        runs.push_back({run.first, run.last, run.curved, run.no_break, run.settled, run.no_arc});
    }
    return runs;
}

inline void set_runs(ale_extractor_t *e, const std::vector<reference::Run> &runs)
{
    e->run_count = static_cast<uint16_t>(runs.size());
    for (size_t k = 0; k < runs.size(); k++) {
        e->run[k] = {};
        e->run[k].first = static_cast<uint16_t>(runs[k].first);
        e->run[k].last = static_cast<uint16_t>(runs[k].last);
        e->run[k].curved = runs[k].curved;
        e->run[k].no_break = runs[k].no_break;
        e->run[k].settled = runs[k].settled;
        e->run[k].no_arc = runs[k].no_arc;
    }
}

} // namespace scene

#endif
