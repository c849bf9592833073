#include "extract/extract.h"

#include <string.h>

#include "base/fixed.h"
#include "extract/breakpoint.h"
#include "extract/corner.h"
#include "extract/curve.h"
#include "extract/line_fit.h"
#include "extract/merge.h"
#include "extract/moments.h"
#include "extract/outlier.h"
#include "extract/points.h"
#include "extract/runs.h"
#include "extract/scan_noise.h"
#include "extract/segment.h"
#include "extract/workspace.h"

enum {
    HIGH_Z = 4,
    MOST_ROUNDS = 2, /* of splitting, joining and placing, where a round changes something */
    LOW_Z = 3,
    CLUTTER_LONGER = 4, /* thirds of the fewest points of a line, where there is clutter */
    ROUGH_OWN_Q2 = 6,   /* own variances that a line may have beyond its bound: the measured noise errs too */
    ROUGH_SHARED = 12,  /* shared variances that a long wall may be wavy by, */
    ROUGH_REACHES = 4   /* and the reaches of the shared error from which on it is a long one */
};
static const int64_t MAX_SIGMA_ALPHA_NRAD = 139626340; /* 8 degrees: a line of no known direction is none */

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

static bool noise_in_range(const ale_noise_t *n)
{
    return n->own_um >= 0 && n->own_um <= 100000 && n->own_ppm >= 0 && n->own_ppm <= 100000 &&
           n->shared_um >= 0 && n->shared_um <= 100000 && n->shared_ppm >= 0 && n->shared_ppm <= 100000 &&
           n->shared_beams >= 1 && n->shared_beams <= ALE_MAX_BEAMS && n->surface_um >= 0 &&
           n->surface_um <= 100000 && n->bearing_nrad >= 0 && n->bearing_nrad <= 100000000;
}

/* Chi square that n points about a fitted line exceed as seldom as a Gauss curve z deviations, by Wilson and
 * Hilferty: k (1 - h + z sqrt(h))^3 with h = 2 / 9 k and k = n - 2 degrees of freedom. */
static int32_t chi_limit_q8(int32_t n, int32_t z)
{
    const int64_t freedom = n > 2 ? n - 2 : 1;
    const int64_t h_q20 = ((int64_t)2 << 20) / (9 * freedom);
    const int64_t root_q20 = ((int64_t)1 << 20) - h_q20 + z * (int64_t)ale_isqrt((uint64_t)h_q20 << 20);
    return (int32_t)(freedom * ((((root_q20 * root_q20) >> 20) * root_q20) >> 20) >> 12);
}

int ale_extractor_init(ale_extractor_t *e, const ale_extract_config_t *config)
{
    if (!noise_in_range(&config->noise) || config->min_points < ALE_MIN_RUN ||
        config->min_points > ALE_MAX_BEAMS || config->min_length_um < 0 || config->smooth_span % 2 != 1 ||
        config->smooth_span > ALE_MAX_SPAN || config->robust_passes > 8) {
        return -1;
    }
    memset(e, 0, sizeof *e);
    e->config = *config;
    for (int32_t n = 0; n <= ALE_MAX_BEAMS; n++) {
        e->chi_low_q8[n] = chi_limit_q8(n, LOW_Z);
        e->chi_high_q8[n] = chi_limit_q8(n, HIGH_Z);
    }
    return 0;
}

void ale_extractor_set_hook(ale_extractor_t *e, const ale_stage_hook_t *hook)
{
    e->hook = hook ? *hook : (ale_stage_hook_t){0};
}

/* Squared residuals that a line may have. What neighbours share bends a short line hardly at all. */
static int64_t rough_q8(const ale_extractor_t *e, const ale_run_fit_t *fit)
{
    const int64_t own = ((fit->var_q8 * e->chi_high_q8[fit->n]) >> 8) * ROUGH_OWN_Q2 / 4;
    const int64_t n2 = (int64_t)fit->n * fit->n;
    const int64_t reach = (int64_t)ROUGH_REACHES * e->config.noise.shared_beams;
    const int64_t share_q8 = (n2 << 8) / (n2 + reach * reach);
    return own + ((ROUGH_SHARED * fit->shared_q8 * fit->n * share_q8) >> 8);
}

static bool is_line(ale_extractor_t *e, const ale_line_t *line)
{
    const int64_t dx = (int64_t)line->start.x_um - line->end.x_um;
    const int64_t dy = (int64_t)line->start.y_um - line->end.y_um;
    if (dx * dx + dy * dy < (int64_t)e->config.min_length_um * e->config.min_length_um) {
        e->refused[ALE_REFUSED_SHORT]++;
        return false;
    }
    if (line->var_alpha_nrad2 > MAX_SIGMA_ALPHA_NRAD * MAX_SIGMA_ALPHA_NRAD) {
        e->refused[ALE_REFUSED_VAGUE]++;
        return false;
    }
    return true;
}

/* A run of enough points, as smooth as its noise lets it be. */
static bool is_wall(ale_extractor_t *e, ale_run_t *run)
{
    if (run->last + 1 - run->first < e->config.min_points) {
        e->refused[ALE_REFUSED_FEW_POINTS]++;
        return false;
    }
    const ale_run_fit_t *fit = ale_fit_of_run(e, run);
    if (fit->sse_q8 > rough_q8(e, fit)) {
        e->refused[ALE_REFUSED_ROUGH]++;
        return false;
    }
    return true;
}

static uint8_t end_kind(const ale_extractor_t *e, int32_t end, int32_t beyond)
{
    if (beyond < 0 || beyond >= e->count || ale_abs64(e->beam[end] - e->beam[beyond]) > 8) {
        return ALE_END_LIMIT;
    }
    const bool jump = e->jump_after[end < beyond ? end : beyond];
    return jump && e->range_um[beyond] < e->range_um[end] ? ALE_END_OCCLUDED : ALE_END_EDGE;
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

static void write_curve(ale_extractor_t *e, ale_segment_t run, const frame_t *frame, ale_features_t *out)
{
    e->refused[ALE_REFUSED_CURVED]++;
    if (out->curve_count == ALE_MAX_CURVES) {
        e->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    ale_curve_t *curve = &out->curve[out->curve_count++];
    ale_curve_fit(e, run, curve);
    curve->centre = ale_turn(curve->centre, frame->direction);
}

static void write_line(ale_extractor_t *e, ale_run_t *wall, const frame_t *frame, ale_features_t *out)
{
    ale_run_trim(e, wall);
    const ale_segment_t run = {wall->first, wall->last};
    ale_line_t line;
    ale_line_fit(e, run, &line);
    if (!is_line(e, &line)) {
        return;
    }
    if (out->line_count == ALE_MAX_LINES) {
        e->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    line.first_end = end_kind(e, run.first, run.first - 1);
    line.last_end = end_kind(e, run.last, run.last + 1);
    turn_line(&line, frame);
    out->line[out->line_count++] = line;
}

/* Fits the runs and gives them out in the sensor's frame. */
static void write_features(ale_extractor_t *e, uint32_t frame_bam, ale_features_t *out)
{
    const frame_t frame = {frame_bam, ale_direction(frame_bam)};
    out->line_count = 0;
    out->curve_count = 0;
    for (int32_t k = 0; k < e->run_count; k++) {
        ale_run_t *run = &e->run[k];
        if (run->curved) {
            write_curve(e, (ale_segment_t){run->first, run->last}, &frame, out);
        } else if (is_wall(e, run)) {
            write_line(e, run, &frame, out);
        }
    }
    ale_corner_find(e->step_nrad, out);
    out->outliers = e->outliers;
    memcpy(out->refused, e->refused, sizeof out->refused);
}

/* Points whose surfaces are told apart: stray ones removed, segments cut, noise measured. */
static void prepare_points(ale_extractor_t *e, const ale_scan_t *scan)
{
    ale_points_list(e, scan);
    ale_scan_noise_measure(e, scan);
    ale_segment_suspect(e);
    ale_outlier_remove_spikes(e);
    ale_segment(e, scan);
    if (ale_outlier_remove_strays(e)) {
        ale_segment(e, scan);
    }
}

/* Lowess of 1 / range, segment by segment; the points move to the smoothed ranges. */
static void smooth_points(ale_extractor_t *e)
{
    const ale_lowess_config_t config = {e->config.smooth_span, e->config.robust_passes, 1};
    for (int32_t k = 0; k < e->segment_count; k++) {
        const ale_segment_t s = e->segment[k];
        ale_lowess(&config, &e->beam[s.first], &e->inverse_q44[s.first], s.last + 1 - s.first,
                   &e->smooth_q44[s.first], &e->lowess);
    }
    ale_points_place_smoothed(e);
}

static bool is_clutter(const ale_extractor_t *e)
{
    return e->run_count > (ale_costly(e) ? ALE_MANY_RUNS / 3 : ALE_MANY_RUNS);
}

static void search_runs(ale_extractor_t *e, const ale_scan_t *scan)
{
    ale_runs_search(e);
    if (ale_scan_noise_measure_shared(e, scan)) {
        if (ale_costly(e)) {
            ale_runs_forget_fits(e);
        } else {
            ale_runs_search(e);
        }
    }
}

/* A break that was missed spoils those beside it: once it is found, and they are placed anew, others show.
 * Not so where neighbours share an error, whose waves every further round would follow. */
static void split_runs(ale_extractor_t *e)
{
    const int32_t rounds = e->shared_scale_q8 > 256 || ale_costly(e) ? 1 : MOST_ROUNDS;
    bool changed = true;
    for (int32_t round = 0; changed && round < rounds && !ale_effort_is_spent(e); round++) {
        const bool split = ale_runs_split(e);
        changed = ale_merge_runs(e) || split;
        if (!ale_runs_place_again(e, round == 0 ? ALE_BREAK_FINE_STEP : ALE_BREAK_WIDE_STEP)) {
            break; /* new breaks are placed well enough: see ale_break_find */
        }
        if (changed) {
            ale_scan_noise_refine_own(e);
        }
    }
}

/* What the search found, made good on the raw points. Of clutter only the most needed, for the time is
 * bounded. */
static void improve_runs(ale_extractor_t *e)
{
    if (is_clutter(e)) {
        ale_scan_noise_refine_own(e);
        ale_runs_drop_short(e, e->config.min_points * CLUTTER_LONGER / 3, ALE_MANY_RUNS);
        ale_merge_runs(e);
        return;
    }
    ale_merge_runs(e);
    ale_runs_place(e, ALE_BREAK_WIDE_STEP);
    ale_scan_noise_refine_own(e); /* each run now has the points that are its own */
    ale_curve_find(e, false);
    split_runs(e);
    if (!ale_effort_is_spent(e)) {
        ale_curve_find(e, true);
    }
    if (e->shared_scale_q8 > 256 && ale_runs_split_at_steps(e)) {
        ale_runs_place_again(e, ALE_BREAK_WIDE_STEP);
    }
}

__attribute__((noinline)) void ale_extract_scan(ale_extractor_t *e, const ale_scan_t *scan,
                                                const uint32_t *bearing_bam, ale_features_t *out)
{
    const bool smoothed = e->config.smooth_span > 1;
    prepare_points(e, scan);
    ale_points_place(e, scan, bearing_bam);
    if (smoothed) {
        smooth_points(e);
    }
    ale_stage_end(&e->hook, ALE_STAGE_SMOOTH);
    ale_moments_build(e);
    search_runs(e, scan);
    if (smoothed) {
        ale_points_place(e, scan, bearing_bam);
        ale_moments_build(e);
        ale_runs_forget_fits(e);
    }
    improve_runs(e);
    write_features(e, ale_points_frame_bam(e, scan), out);
    ale_stage_end(&e->hook, ALE_STAGE_EXTRACT);
}
