#include "extract/extract.h"

#include <string.h>

#include "base/fixed.h"
#include "extract/breakpoint.h"
#include "extract/corner.h"
#include "extract/curve.h"
#include "extract/line_fit.h"
#include "extract/lowess.h"
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
#include "extract/workspace.h"

enum {
    MOST_DEVIATION = 100000, /* um, ppm */
    MOST_PPM_PER_M = 10000,
    MOST_BEARING_NRAD = 100000000,
    MOST_ROBUST_PASSES = 8,
    MOST_ROUNDS = 2,    /* of splitting, joining and placing, where a round changes something */
    CLUTTER_LONGER = 4, /* thirds of the fewest points of a line, where there is clutter */
    ROUGH_OWN_Q2 = 6,   /* own variances that a line may have beyond its bound: the measured noise errs too */
    ROUGH_SHARED = 12,  /* shared variances that a long wall may be wavy by, */
    ROUGH_REACHES = 4   /* and the reaches of the shared error from which on it is a long one */
};

ale_extract_config_t ale_extract_default_config(void)
{
    const ale_extract_config_t config = {
        .noise = ale_noise_default(),
        .min_points = 9,
        .min_length_um = 140000,
        .smooth_span = 1,
        .robust_passes = 2,
    };
    return config;
}

uint32_t ale_extractor_size(void)
{
    return (uint32_t)sizeof(ale_extractor_t);
}

static bool within(int32_t value, int32_t least, int32_t most)
{
    return least <= value && value <= most;
}

static bool noise_in_range(const ale_noise_t *n)
{
    return within(n->own_um, 0, MOST_DEVIATION) && within(n->own_ppm, 0, MOST_DEVIATION) &&
           within(n->own_ppm_per_m, 0, MOST_PPM_PER_M) && within(n->shared_um, 0, MOST_DEVIATION) &&
           within(n->shared_ppm, 0, MOST_DEVIATION) && within(n->shared_beams, 1, ALE_MAX_BEAMS) &&
           within(n->surface_um, 0, MOST_DEVIATION) && within(n->bearing_nrad, 0, MOST_BEARING_NRAD);
}

int ale_extractor_init(ale_extractor_t *e, const ale_extract_config_t *config)
{
    if (!noise_in_range(&config->noise) || !within(config->min_points, ALE_MIN_RUN, ALE_MAX_BEAMS) ||
        config->min_length_um < 0 || config->smooth_span % 2 != 1 || config->smooth_span > ALE_MAX_SPAN ||
        config->robust_passes > MOST_ROBUST_PASSES) {
        return -1;
    }
    memset(e, 0, sizeof *e);
    e->config = *config;
    ale_run_list_init(&e->runs, config->min_points);
    return 0;
}

void ale_extractor_set_hook(ale_extractor_t *e, const ale_stage_hook_t *hook)
{
    e->hook = hook ? *hook : (ale_stage_hook_t){0};
}

/* Squared residuals that a line may have. What neighbours share bends a short line hardly at all. */
static int64_t rough_q8(const ale_run_list_t *r, const ale_run_fit_t *fit)
{
    const int64_t own = ((fit->var_q8 * r->chi_high_q8[fit->n]) >> 8) * ROUGH_OWN_Q2 / 4;
    const int64_t n2 = (int64_t)fit->n * fit->n;
    const int64_t reach = (int64_t)ROUGH_REACHES * r->scan.noise.shared_beams;
    const int64_t share_q8 = (n2 << 8) / (n2 + reach * reach);
    return own + ((ROUGH_SHARED * fit->shared_q8 * fit->n * share_q8) >> 8);
}

/* A line long enough, of a known direction. */
static bool is_line(ale_extractor_t *e, const ale_line_t *line)
{
    const int64_t dx = (int64_t)line->start.x_um - line->end.x_um;
    const int64_t dy = (int64_t)line->start.y_um - line->end.y_um;
    if (dx * dx + dy * dy < (int64_t)e->config.min_length_um * e->config.min_length_um) {
        e->runs.refused[ALE_REFUSED_SHORT]++;
        return false;
    }
    if (line->var_alpha_nrad2 > ALE_MOST_VAR_ALPHA_NRAD2) {
        e->runs.refused[ALE_REFUSED_VAGUE]++;
        return false;
    }
    return true;
}

/* A run of enough points, as smooth as its noise lets it be. */
static bool is_wall(ale_run_list_t *r, ale_run_t *run)
{
    if (run->last + 1 - run->first < r->min_points) {
        r->refused[ALE_REFUSED_FEW_POINTS]++;
        return false;
    }
    const ale_run_fit_t *fit = ale_fit_of_run(&r->scan, run);
    if (fit->sse_q8 > rough_q8(r, fit)) {
        r->refused[ALE_REFUSED_ROUGH]++;
        return false;
    }
    return true;
}

static inline uint8_t end_kind(const ale_prepared_scan_t *scan, int32_t end, int32_t side)
{
    const ale_points_t *p = &scan->points;
    const ale_beyond_t beyond = ale_segment_beyond(p, &scan->segments, end, side);
    if (beyond.point < 0 || beyond.gap > ALE_MAX_GAP_BEAMS) {
        return ALE_END_LIMIT;
    }
    return beyond.jump && p->range_um[beyond.point] < p->range_um[end] ? ALE_END_OCCLUDED : ALE_END_EDGE;
}

/* Direction of the points' x axis in the sensor's frame. */
typedef struct {
    uint32_t angle_bam;
    ale_direction_t direction;
} frame_t;

static void turn_line(ale_line_t *line, const frame_t *frame)
{
    line->alpha_bam += frame->angle_bam;
    line->start = ale_turn(line->start, frame->direction);
    line->end = ale_turn(line->end, frame->direction);
}

static void write_curve(ale_run_list_t *r, ale_segment_t run, const frame_t *frame, ale_features_t *out)
{
    r->refused[ALE_REFUSED_CURVED]++;
    if (out->curve_count == ALE_MAX_CURVES) {
        r->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    ale_curve_t *curve = &out->curve[out->curve_count++];
    ale_curve_fit(&r->scan, run, curve);
    curve->centre = ale_turn(curve->centre, frame->direction);
}

static void write_line(ale_extractor_t *e, ale_run_t *wall, const frame_t *frame, ale_features_t *out)
{
    ale_run_trim(&e->runs, wall);
    const ale_segment_t run = {wall->first, wall->last};
    ale_line_t line;
    ale_line_fit(&e->runs.scan, run, &line);
    if (!is_line(e, &line)) {
        return;
    }
    if (out->line_count == ALE_MAX_LINES) {
        e->runs.refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    line.first_end = end_kind(&e->runs.scan, run.first, -1);
    line.last_end = end_kind(&e->runs.scan, run.last, 1);
    turn_line(&line, frame);
    out->line[out->line_count++] = line;
}

/* The run that begins with the lowest beam of the scan: where the order of the points began within the turn
 * it is not the first one. */
static int32_t first_in_scan(const ale_run_list_t *r)
{
    const int32_t turn_beams = r->scan.points.turn_beams;
    int32_t k = turn_beams > 0 ? 0 : r->count;
    while (k < r->count && r->scan.points.beam[r->run[k].first] < turn_beams) {
        k++;
    }
    return k < r->count ? k : 0;
}

/* Fits the runs and gives them out in the sensor's frame. */
static void write_features(ale_extractor_t *e, ale_features_t *out)
{
    const ale_points_t *points = &e->runs.scan.points;
    const frame_t frame = {points->frame_bam, ale_direction(points->frame_bam)};
    const int32_t first = first_in_scan(&e->runs);
    out->line_count = 0;
    out->curve_count = 0;
    for (int32_t i = 0; i < e->runs.count; i++) {
        ale_run_t *run = &e->runs.run[first + i < e->runs.count ? first + i : first + i - e->runs.count];
        if (run->curved) {
            write_curve(&e->runs, (ale_segment_t){run->first, run->last}, &frame, out);
        } else if (is_wall(&e->runs, run)) {
            write_line(e, run, &frame, out);
        }
    }
    ale_corner_find(points->step_nrad, points->turn_beams, out);
    out->outliers = e->outliers;
    memcpy(out->refused, e->runs.refused, sizeof out->refused);
}

/* Points whose surfaces are told apart: noise measured, stray points removed, segments cut. */
static void prepare_points(ale_extractor_t *e, const ale_scan_t *scan, const uint32_t *bearing_bam)
{
    ale_points_t *points = &e->runs.scan.points;
    ale_scan_noise_t *noise = &e->runs.scan.noise;
    ale_segments_t *segments = &e->runs.scan.segments;
    ale_points_list(points, scan, bearing_bam);
    if (points->turn_beams > 0) {
        ale_seam_open(&e->runs.scan);
    }
    ale_scan_noise_measure(noise, &e->config.noise, points, scan);
    ale_segment_suspect(segments, points, noise);
    e->runs.effort = segments->suspect_count;
    const int32_t spikes = ale_outlier_remove_spikes(points, segments, noise);
    ale_segment_cut(segments, points, noise);
    const int32_t strays = ale_outlier_remove_strays(points, segments);
    if (strays > 0) {
        ale_segment_cut(segments, points, noise);
    }
    e->outliers = (uint16_t)(spikes + strays);
}

/* Lowess of 1 / range, segment by segment; the points move to the smoothed ranges. */
static void smooth_points(ale_extractor_t *e)
{
    const ale_lowess_config_t config = {e->config.smooth_span, e->config.robust_passes, 1};
    ale_points_t *points = &e->runs.scan.points;
    const ale_segments_t *segments = &e->runs.scan.segments;
    for (int32_t k = 0; k < segments->count; k++) {
        const ale_segment_t s = segments->segment[k];
        ale_lowess(&config, &points->beam[s.first], &points->inverse_q44[s.first], s.last + 1 - s.first,
                   &e->smooth_q44[s.first], &e->lowess);
    }
    ale_points_place_smoothed(points, e->smooth_q44);
}

static void search_runs(ale_run_list_t *r, int32_t step_bam)
{
    ale_runs_search(r);
    if (ale_run_noise_measure_shared(r, step_bam)) {
        if (ale_costly(r)) {
            ale_run_list_forget_fits(r);
        } else {
            ale_runs_search(r);
        }
    }
}

static bool is_clutter(const ale_run_list_t *r)
{
    return r->count > (ale_costly(r) ? ALE_MANY_RUNS / 3 : ALE_MANY_RUNS);
}

/* A break that was missed spoils those beside it: once it is found, and they are placed anew, others show.
 * Not so where neighbours share an error, whose waves every further round would follow. */
static void split_runs(ale_run_list_t *r)
{
    const int32_t rounds = r->scan.noise.shared_scale_q8 > 256 || ale_costly(r) ? 1 : MOST_ROUNDS;
    bool changed = true;
    for (int32_t round = 0; changed && round < rounds && !ale_effort_is_spent(r); round++) {
        const bool split = ale_runs_split(r);
        changed = ale_merge_runs(r) || split;
        if (!ale_runs_place_again(r, round == 0 ? ALE_BREAK_FINE_STEP : ALE_BREAK_WIDE_STEP)) {
            break; /* new breaks are placed well enough: see ale_break_find */
        }
        if (changed) {
            ale_run_noise_refine_own(r);
        }
    }
}

/* What the search found, made good on the raw points. Of clutter only the most needed, for the time is
 * bounded. */
static void improve_runs(ale_run_list_t *r)
{
    if (is_clutter(r)) {
        ale_run_noise_refine_own(r);
        ale_run_list_drop_short(r, r->min_points * CLUTTER_LONGER / 3, ALE_MANY_RUNS);
        ale_merge_runs(r);
        return;
    }
    ale_merge_runs(r);
    ale_runs_place(r, ALE_BREAK_WIDE_STEP);
    ale_run_noise_refine_own(r); /* each run now has the points that are its own */
    ale_curve_find(r, false);
    split_runs(r);
    if (!ale_effort_is_spent(r)) {
        ale_curve_find(r, true);
    }
    if (r->scan.noise.shared_scale_q8 > 256 && ale_runs_split_at_steps(r)) {
        ale_runs_place_again(r, ALE_BREAK_WIDE_STEP);
    }
}

__attribute__((noinline)) void ale_extract_scan(ale_extractor_t *e, const ale_scan_t *scan,
                                                const uint32_t *bearing_bam, ale_features_t *out)
{
    ale_prepared_scan_t *prepared = &e->runs.scan;
    const bool smoothed = e->config.smooth_span > 1;
    prepare_points(e, scan, bearing_bam);
    ale_points_place(&prepared->points, scan, bearing_bam);
    if (smoothed) {
        smooth_points(e);
    }
    ale_stage_end(&e->hook, ALE_STAGE_SMOOTH);
    ale_moments_build(prepared);
    search_runs(&e->runs, scan->step_bam);
    if (smoothed) {
        ale_points_place(&prepared->points, scan, bearing_bam);
        ale_moments_build(prepared);
        ale_run_list_forget_fits(&e->runs);
    }
    improve_runs(&e->runs);
    if (prepared->points.turn_beams > 0) {
        ale_seam_close(&e->runs);
    }
    write_features(e, out);
    ale_stage_end(&e->hook, ALE_STAGE_EXTRACT);
}

int ale_extractor_set_noise(ale_extractor_t *e, const ale_noise_t *noise)
{
    if (!noise_in_range(noise)) {
        return -1;
    }
    e->config.noise = *noise;
    return 0;
}

ale_noise_t ale_extractor_noise(const ale_extractor_t *e)
{
    const ale_scan_noise_t *measured = &e->runs.scan.noise;
    ale_noise_t noise = e->config.noise;
    noise.own_um = (int32_t)ale_isqrt((uint64_t)ale_mul_shift(measured->own_mm2_q36, 1000000, 36));
    noise.own_ppm =
        (int32_t)ale_isqrt((uint64_t)ale_mul_shift(measured->own_relative_q36, 1000000000000, 36));
    noise.own_ppm_per_m =
        (int32_t)ale_isqrt((uint64_t)ale_mul_shift(measured->own_square_q60, 1000000000000000000, 60));
    return noise;
}
