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
#include "extract/run_noise.h"
#include "extract/runs.h"
#include "extract/scan_noise.h"
#include "extract/segment.h"
}

namespace scene
{

// Points listed, their noise measured.
inline void list_points(ale_extractor_t *e, const ale_scan_t &scan)
{
    ale_prepared_scan_t &s = e->runs.scan;
    ale_points_list(&s.points, &scan, nullptr);
    ale_scan_noise_measure(&s.noise, &e->config.noise, &s.points, &scan);
    ale_segment_suspect(&s.segments, &s.points, &s.noise);
    e->runs.effort = s.segments.suspect_count;
}

inline int remove_spikes(ale_extractor_t *e)
{
    ale_prepared_scan_t &s = e->runs.scan;
    return ale_outlier_remove_spikes(&s.points, &s.segments, &s.noise);
}

inline void cut_segments(ale_extractor_t *e)
{
    ale_prepared_scan_t &s = e->runs.scan;
    ale_segment_cut(&s.segments, &s.points, &s.noise);
}

inline int remove_strays(ale_extractor_t *e)
{
    return ale_outlier_remove_strays(&e->runs.scan.points, &e->runs.scan.segments);
}

// Strays removed, segments cut, points placed: ready for fits.
inline void prepare_points(ale_extractor_t *e, const ale_scan_t &scan)
{
    list_points(e, scan);
    remove_spikes(e);
    cut_segments(e);
    if (remove_strays(e) > 0) {
        cut_segments(e);
    }
    ale_points_place(&e->runs.scan.points, &scan, nullptr);
    ale_moments_build(&e->runs.scan);
}

// Runs as the search leaves them, with the noise that they show.
inline void search_runs(ale_extractor_t *e, const ale_scan_t &scan)
{
    prepare_points(e, scan);
    ale_runs_search(&e->runs);
    if (ale_run_noise_measure_shared(&e->runs, scan.step_bam)) {
        ale_runs_search(&e->runs);
    } else {
        ale_run_noise_refine_own(&e->runs);
    }
}

inline void place_runs(ale_run_list_t *runs)
{
    ale_runs_place(runs, ALE_BREAK_WIDE_STEP);
}

} // namespace scene

#endif
