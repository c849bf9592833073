// The extractor's working memory in the twins' units, so that a stage and its twin see the same.
#ifndef ALE_TESTS_LIB_EXTRACT_AS_REFERENCE_H
#define ALE_TESTS_LIB_EXTRACT_AS_REFERENCE_H

#include <cmath>
#include <vector>

#include "reference/scan_points.h"

extern "C" {
#include "extract/extract.h"
#include "extract/workspace.h"
}

namespace scene
{

inline reference::ScanPoints points_of(const ale_extractor_t &e)
{
    reference::ScanPoints points;
    const ale_points_t &p = e.runs.scan.points;
    for (int i = 0; i < p.count; i++) {
        points.push_back({p.beam[i], p.range_um[i] / 1000.0, p.x_q4[i] / 16.0, p.y_q4[i] / 16.0});
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
    const ale_scan_noise_t &n = e.runs.scan.noise;
    const bool shows_shared = n.shared_scale_q8 > 256;
    return {static_cast<double>(n.own_mm2_q36) * q36,
            static_cast<double>(n.own_relative_q36) * q36,
            static_cast<double>(n.own_scale_q16) / 65536,
            static_cast<double>(n.shared_mm2_q36) * q36,
            static_cast<double>(n.shared_relative_q36) * q36,
            static_cast<double>(n.shared_beams),
            static_cast<double>(n.bearing_rad2_q36) * q36,
            shows_shared ? static_cast<double>(n.shared_stated_q8) / static_cast<double>(n.shared_scale_q8)
                         : 1,
            n.shared_absent,
            shows_shared,
            e.runs.scan.segments.unruly,
            ale_costly(&e.runs)};
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
    const ale_segments_t &cut = e.runs.scan.segments;
    for (int k = 0; k < cut.count; k++) {
        segments.push_back({cut.segment[k].first, cut.segment[k].last});
    }
    return segments;
}

inline std::vector<reference::Run> runs_of(const ale_run_list_t &list)
{
    std::vector<reference::Run> runs;
    for (int k = 0; k < list.count; k++) {
        const ale_run_t &run = list.run[k];
        runs.push_back({run.first, run.last, run.curved, run.no_break, run.settled, run.no_arc});
    }
    return runs;
}

inline void set_runs(ale_run_list_t *list, const std::vector<reference::Run> &runs)
{
    list->count = static_cast<uint16_t>(runs.size());
    for (size_t k = 0; k < runs.size(); k++) {
        list->run[k] = {};
        list->run[k].first = static_cast<uint16_t>(runs[k].first);
        list->run[k].last = static_cast<uint16_t>(runs[k].last);
        list->run[k].curved = runs[k].curved;
        list->run[k].no_break = runs[k].no_break;
        list->run[k].settled = runs[k].settled;
        list->run[k].no_arc = runs[k].no_arc;
    }
}

} // namespace scene

#endif
