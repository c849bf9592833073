// The extractor led through its stages one by one.
#ifndef ALE_TESTS_LIB_EXTRACT_STAGES_H
#define ALE_TESTS_LIB_EXTRACT_STAGES_H

#include "lib/extract/scene.h"
#include "lib/extract/simulated_scans.h"

extern "C" {
#include "extract/breakpoint.h"
#include "extract/curve.h"
#include "extract/merge.h"
#include "extract/moments.h"
#include "extract/outlier.h"
#include "extract/points.h"
#include "extract/runs.h"
#include "extract/scan_noise.h"
#include "extract/segment.h"
}

namespace scene
{

// Points listed, their noise measured.
inline void list_points(ale_extractor_t *e, const ale_scan_t &scan)
{
    ale_points_list(e, &scan);
    ale_scan_noise_measure(e, &scan);
    ale_segment_suspect(e);
}

// Strays removed, segments cut, points placed: ready for fits.
inline void prepare_points(ale_extractor_t *e, const ale_scan_t &scan)
{
    list_points(e, scan);
    ale_outlier_remove_spikes(e);
    ale_segment(e, &scan);
    if (ale_outlier_remove_strays(e)) {
        ale_segment(e, &scan);
    }
    ale_points_place(e, &scan, nullptr);
    ale_moments_build(e);
}

// Runs as the search leaves them, with the noise that they show.
inline void search_runs(ale_extractor_t *e, const ale_scan_t &scan)
{
    prepare_points(e, scan);
    ale_runs_search(e);
    if (ale_scan_noise_measure_shared(e, &scan)) {
        ale_runs_search(e);
    } else {
        ale_scan_noise_refine_own(e);
    }
}

inline void place_runs(ale_extractor_t *e)
{
    ale_runs_place(e, ALE_BREAK_WIDE_STEP);
}

} // namespace scene

#endif
