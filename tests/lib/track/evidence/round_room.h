// A scan of 181 beams that all end at the same range.
#pragma once

#include <memory>

extern "C" {
#include "base/scan.h"
#include "base/trig.h"
}

inline std::unique_ptr<ale_scan_t> round_room(double range_m, double seconds)
{
    auto scan = std::make_unique<ale_scan_t>();
    scan->stamp_us = static_cast<int64_t>(seconds * 1e6);
    scan->first_bearing_bam = 0u - 90u * ALE_BAM_PER_DEGREE;
    scan->step_bam = ALE_BAM_PER_DEGREE;
    scan->range_min_um = 20000;
    scan->range_max_um = 5600000;
    scan->beams = 181;
    for (int k = 0; k < scan->beams; k++) {
        scan->range_um[k] = static_cast<int32_t>(range_m * 1e6);
        scan->flag[k] = ALE_BEAM_VALID;
    }
    return scan;
}
