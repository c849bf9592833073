#include "proofs/wcet/parts.hpp"

#include <cstdint>
#include <memory>
#include <vector>

#include "proofs/wcet/scans.hpp"

extern "C" {
#include "extract/breakpoint.h"
#include "extract/corner.h"
#include "extract/curve.h"
#include "extract/line_fit.h"
#include "extract/merge.h"
#include "extract/moments.h"
#include "extract/outlier.h"
#include "extract/points.h"
#include "extract/run_list.h"
#include "extract/run_noise.h"
#include "extract/runs.h"
#include "extract/scan_noise.h"
#include "extract/seam.h"
#include "extract/segment.h"
#include "motion/deskew.h"
#include "observe/short_segment.h"
#include "track/pipeline_state.h"
#include "track/step_predict.h"
}

namespace bench
{

namespace
{

constexpr int pool_scans = 60;

/* The same with bearings of their own, which every step that asks for them takes one by one. */
ale_scan_t with_own_bearings(const ale_scan_t &scan)
{
    ale_scan_t own = scan;
    own.own_bearings = true;
    own.beam_time_ns = ALE_MAX_SWEEP_US * 1000LL / ALE_MAX_BEAMS; /* as slow as a sweep may be */
    for (int k = 0; k < scan.beams; k++) {
        own.bearing_bam[k] = ale_scan_bearing(&scan, k);
    }
    return own;
}

/* What a whole turn takes besides: its order, and what meets at the seam. */
void open_seam(Parts &parts, ale_prepared_scan_t *scan)
{
    scan->points.turn_beams = ALE_MAX_BEAMS;
    parts.measure("order of a whole turn", 1, [&] { ale_seam_open(scan); });
}

void close_seam(Parts &parts, ale_run_list_t *runs)
{
    runs->scan.points.turn_beams = ALE_MAX_BEAMS;
    runs->scan.segments.jump_at_seam = false;
    parts.measure("seam of a whole turn", 1, [&] { ale_seam_close(runs); });
}

/* The extractor's steps, in the order of ale_extract_scan, each as often as it is taken at most: a scan that
 * is costly to search is searched once; one with more than ALE_MANY_RUNS runs is spared breaks and curves,
 * which cost more than the fits of the runs beyond. */
void extraction(Parts &parts, ale_extractor_t *e, const ale_scan_t &scan, const uint32_t *bearing_bam,
                ale_features_t *out)
{
    ale_run_list_t *runs = &e->runs;
    ale_points_t *points = &runs->scan.points;
    ale_scan_noise_t *noise = &runs->scan.noise;
    ale_segments_t *segments = &runs->scan.segments;
    parts.measure("points", 1, [&] { ale_points_list(points, &scan, bearing_bam); });
    open_seam(parts, &runs->scan);
    ale_points_list(points, &scan, bearing_bam);
    const ale_scan_t own = with_own_bearings(scan);
    for (const ale_scan_t *one : {&own, &scan}) {
        parts.measure("noise of the beams", 1,
                      [&] { ale_scan_noise_measure(noise, &e->config.noise, points, one); });
    }
    parts.measure("suspects", 1, [&] { ale_segment_suspect(segments, points, noise); });
    parts.measure("spikes", 1, [&] { ale_outlier_remove_spikes(points, segments, noise); });
    parts.measure("segments", 1, [&] { ale_segment_cut(segments, points, noise); });
    parts.measure("stray points", 1, [&] { ale_outlier_remove_strays(points, segments); });
    parts.measure("segments again", 1, [&] { ale_segment_cut(segments, points, noise); });
    parts.measure("places of the points", 1, [&] { ale_points_place(points, &scan, bearing_bam); });
    parts.measure("moments", 1, [&] { ale_moments_build(&runs->scan); });
    parts.measure("search of the runs", 1, [&] { ale_runs_search(runs); });
    parts.measure("shared noise", 1, [&] { ale_run_noise_measure_shared(runs, scan.step_bam); });
    ale_run_list_forget_fits(runs);
    parts.measure("own noise again", 1, [&] { ale_run_noise_refine_own(runs); });
    if (runs->count > (ale_costly(runs) ? ALE_MANY_RUNS / 3 : ALE_MANY_RUNS)) {
        ale_run_list_drop_short(runs, ALE_COSTLY_RUN, ALE_MANY_RUNS);
        parts.measure("runs joined", 1, [&] { ale_merge_runs(runs); });
    } else {
        parts.measure("runs joined", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed", 1, [&] { ale_runs_place(runs, ALE_BREAK_WIDE_STEP); });
        parts.measure("curves", 1, [&] { ale_curve_find(runs, false); });
        parts.measure("runs split", 1, [&] { ale_runs_split(runs); });
        parts.measure("runs joined again", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed again", 1, [&] { ale_runs_place(runs, ALE_BREAK_FINE_STEP); });
        parts.measure("own noise, third time", 1, [&] { ale_run_noise_refine_own(runs); });
        parts.measure("runs split again", 1, [&] { ale_runs_split(runs); });
        parts.measure("runs joined, third time", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed, third time", 1, [&] { ale_runs_place(runs, ALE_BREAK_WIDE_STEP); });
        runs->run[0].no_curve = false; // one that has changed, and all are asked
        parts.measure("curves again", 1, [&] { ale_curve_find(runs, true); });
    }
    close_seam(parts, runs);
    for (int32_t k = 0; k < runs->count; k++) {
        ale_line_t line;
        parts.measure("a line's fit", ALE_MANY_RUNS, [&] {
            ale_line_fit(&runs->scan, {runs->run[k].first, runs->run[k].last}, &line);
        });
    }
    ale_extract_scan(e, &scan, nullptr, out);
    parts.measure("corners", 1, [&] { ale_corner_find(points->step_nrad, points->turn_beams, out); });
}

void looking(Parts &parts)
{
    Random random(3);
    const ale_pipeline_config_t config = ale_pipeline_default_config();
    const ale_noise_t &noise = config.extract.noise;
    auto extractor = std::make_unique<ale_extractor_t>();
    auto features = std::make_unique<ale_features_t>();
    auto pieces = std::make_unique<ale_segment_workspace_t>();
    std::vector<ale_observation_t> views(ALE_MAX_OBSERVATIONS);
    ale_extractor_init(extractor.get(), &config.extract);
    const ale_scan_t first =
        any_scan(random); /* with it the beams' directions are listed; it meets an empty map */
    ale_extract_scan(extractor.get(), &first, nullptr, features.get());
    for (int k = 0; k < pool_scans; k++) {
        std::vector<uint32_t> bearing(ALE_MAX_BEAMS);
        ale_scan_t moved = any_scan(random);
        const int32_t velocity[ALE_AXES] = {40000, 20000, 60000};
        ale_scan_t own = with_own_bearings(moved);
        parts.measure("straightening", 1, [&] { ale_deskew(&moved, velocity, bearing.data()); });
        parts.measure("straightening", 1, [&] { ale_deskew(&own, velocity, bearing.data()); });
        extraction(parts, extractor.get(), any_scan(random), bearing.data(), features.get());
        const ale_scan_t scan = any_scan(random);
        ale_extract_scan(extractor.get(), &scan, bearing.data(), features.get());
        parts.measure("views of lines", 1, [&] {
            ale_observe_lines(features.get(), &scan, {0, 0, 0}, 3000, views.data());
        });
        features->line_count = 0;
        parts.measure("views of pieces", 1, [&] {
            const ale_posed_scan_t from = {&scan, bearing.data(), {0, 0, 0}};
            ale_observe_segments(features.get(), &from, &noise, pieces.get(), ALE_MAX_OBSERVATIONS,
                                 views.data());
        });
    }
}

/* Wheels at a thousand samples a second, on a way that turns; the lag's row has waited for all it may take.
 */
void wheels(Parts &parts)
{
    auto wheels = std::make_unique<ale_wheels_t>();
    ale_wheels_init(wheels.get(), 3000, 6000);
    ale_lag_t lag;
    ale_lag_init(&lag, 0);
    ale_wheel_errors_t errors = {35000, 20000, {}};
    ale_wheel_scale_init(&errors.scale, 50000);
    const auto turned = [](int64_t t_us) { return static_cast<uint32_t>(t_us * 700); };
    for (int64_t t_us = 0; t_us <= 1500000; t_us += 10000) {
        const ale_odometry_t sample = {t_us, {static_cast<int32_t>(t_us / 4), 0, turned(t_us)}};
        ale_wheels_add(wheels.get(), &sample);
    }
    for (int64_t t_us = 0; t_us <= 1500000; t_us += 100000) {
        const ale_heading_t heading = {t_us, turned(t_us), 65536};
        ale_lag_add_heading(&lag, &heading);
    }
    lag.done_us = 500000;
    ale_wheel_motion_t motion;
    /* since the last scan and, where it was waited from, since one has told the pose */
    parts.measure("way of the wheels", 2,
                  [&] { ale_wheel_motion(wheels.get(), &lag, &errors, 300000, 1450000, &motion); });
    ale_pose_t unwatched;
    int32_t beyond_us;
    parts.measure("way through a time unwatched", 1,
                  [&] { ale_wheels_motion(wheels.get(), 300000, 400000, &unwatched, &beyond_us); });
    parts.measure("lag of the wheels", 1, [&] { ale_lag_update(&lag, wheels.get()); });
}

/* Prediction, answer and what else a scan of any size asks for: a dropped one needs it too. */
void always(Parts &parts)
{
    const ale_pipeline_config_t config = ale_pipeline_default_config();
    auto pipeline = std::make_unique<ale_pipeline>();
    ale_pipeline_init(pipeline.get(), &config);
    Random random(4);
    const ale_scan_t scan = any_scan(random);
    ale_estimate_t estimate;
    ale_pipeline_scan(pipeline.get(), &scan, &estimate);
    parts.measure("prediction and answer", 1,
                  [&] { ale_pipeline_dropped(pipeline.get(), scan.stamp_us + 100000, &estimate); });
    const ale_motion_t by_wheels = pipeline->motion;
    ale_ways_t ways;
    /* and by wheels, where it was waited from */
    parts.measure("going on as before", 2, [&] {
        ale_motion_t as_before = by_wheels;
        ale_pipeline_predict_motion(pipeline.get(), &as_before, by_wheels.stamp_us + 100000, nullptr);
        ways = ale_ways_of(&by_wheels, &as_before, true);
    });
}

} // namespace

void count_every_scan(Parts &parts)
{
    looking(parts);
    wheels(parts);
    always(parts);
}

} // namespace bench
