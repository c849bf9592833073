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
#include "extract/scan_noise.h"
#include "extract/segment.h"
#include "extract/workspace.h"

enum {
    HIGH_Z = 4,
    LOW_Z = 1,
    ROUGH_SHARED = 6 /* shared variances that a wall may be wavy by */
};
static const int64_t MAX_SIGMA_ALPHA_NRAD = 122173048; /* 7 degrees: a line of no known direction is none */

ale_extract_config_t ale_extract_default_config(void)
{
    const ale_extract_config_t config = {
        .noise = ale_noise_default(),
        .min_points = 9,
        .min_length_um = 120000,
        .smooth_span = 7,
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

/* Chi square of n points about a fitted line: n - 2 and z deviations of it, sqrt(2 (n - 2)). */
static int32_t chi_limit_q8(int32_t n, int32_t z)
{
    const int32_t freedom = n > 2 ? n - 2 : 1;
    return freedom * 256 + z * (int32_t)ale_isqrt((uint64_t)freedom << 17) + 0;
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

static void add_run(ale_extractor_t *e, int32_t a, int32_t b)
{
    if (e->run_count >= ALE_MAX_RUNS) {
        e->refused[ALE_REFUSED_CAPACITY]++;
        return;
    }
    e->run[e->run_count].first = (uint16_t)(a < b ? a : b);
    e->run[e->run_count].last = (uint16_t)(a < b ? b : a);
    e->run[e->run_count].curved = false;
    e->run_count++;
}

/* A segment is read from its nearer end, so that both directions of a scan give the same lines. */
static int32_t reading_direction(const ale_extractor_t *e, int32_t first, int32_t last)
{
    for (int32_t a = first, b = last; a < b; a++, b--) {
        if (e->range_um[a] != e->range_um[b]) {
            return e->range_um[a] < e->range_um[b] ? 1 : -1;
        }
    }
    return 1;
}

static void reverse_runs(ale_extractor_t *e, int32_t from)
{
    for (int32_t a = from, b = e->run_count - 1; a < b; a++, b--) {
        const ale_run_t run = e->run[a];
        e->run[a] = e->run[b];
        e->run[b] = run;
    }
}

static void search_segment(ale_extractor_t *e, int32_t first, int32_t last)
{
    if (last - first + 1 < ALE_MIN_RUN) {
        e->refused[ALE_REFUSED_FEW_POINTS]++;
        return;
    }
    const int32_t direction = reading_direction(e, first, last);
    const int32_t stop = direction > 0 ? last : first;
    const int32_t first_run = e->run_count;
    int32_t from = direction > 0 ? first : last;
    while ((stop - from) * direction + 1 >= ALE_MIN_RUN) {
        const int32_t to = ale_break_search(e, from, stop);
        if (to != from) {
            add_run(e, from, to);
        }
        from = to + direction;
    }
    if (direction < 0) {
        reverse_runs(e, first_run);
    }
}

static void place_breaks(ale_extractor_t *e)
{
    for (int32_t k = 0; k + 1 < e->run_count; k++) {
        ale_run_t *a = &e->run[k];
        ale_run_t *b = &e->run[k + 1];
        if (b->first - a->last > 4 || e->segment_of[a->last] != e->segment_of[b->first] || a->curved ||
            b->curved) {
            continue;
        }
        const int32_t split = ale_break_place(e, *a, *b, 1);
        a->last = (uint16_t)split;
        b->first = (uint16_t)(split + 1);
    }
}

static void insert_run(ale_extractor_t *e, int32_t k, int32_t split)
{
    for (int32_t i = e->run_count; i > k; i--) {
        e->run[i] = e->run[i - 1];
    }
    e->run[k + 1] = e->run[k];
    e->run[k + 1].first = (uint16_t)(split + 1);
    e->run[k].last = (uint16_t)split;
    e->run_count++;
}

static void split_runs(ale_extractor_t *e)
{
    int32_t k = 0;
    while (k < e->run_count && e->run_count < ALE_MAX_RUNS) {
        const int32_t split =
            e->run[k].curved
                ? -1
                : ale_break_find(e, e->run[k], reading_direction(e, e->run[k].first, e->run[k].last));
        if (split >= 0) {
            insert_run(e, k, split);
        } else {
            k++;
        }
    }
}

static void search_all(ale_extractor_t *e)
{
    int32_t first = 0;
    uint16_t segment = 0;
    e->run_count = 0;
    for (int32_t i = 0; i < e->count; i++) {
        e->segment_of[i] = segment;
        if (e->jump_after[i]) {
            search_segment(e, first, i);
            first = i + 1;
            segment++;
        }
    }
}

static bool is_line(ale_extractor_t *e, ale_run_t run, const ale_line_t *line)
{
    const ale_fit_t fit = ale_moments_fit(e, run.first, run.last);
    if (fit.n < e->config.min_points) {
        e->refused[ALE_REFUSED_FEW_POINTS]++;
        return false;
    }
    const int64_t dx = (int64_t)line->start.x_um - line->end.x_um;
    const int64_t dy = (int64_t)line->start.y_um - line->end.y_um;
    if (dx * dx + dy * dy < (int64_t)e->config.min_length_um * e->config.min_length_um) {
        e->refused[ALE_REFUSED_SHORT]++;
        return false;
    }
    const int64_t limit = ((fit.var_q8 * e->chi_high_q8[fit.n]) >> 8) + ROUGH_SHARED * fit.shared_q8 * fit.n;
    if (line->var_alpha_nrad2 > MAX_SIGMA_ALPHA_NRAD * MAX_SIGMA_ALPHA_NRAD) {
        e->refused[ALE_REFUSED_SHORT]++;
        return false;
    }
    if (fit.sse_q8 > limit) {
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

static void write_lines(ale_extractor_t *e, ale_features_t *out)
{
    for (int32_t k = 0; k < e->run_count; k++) {
        if (e->run[k].curved) {
            e->refused[ALE_REFUSED_CURVED]++;
            if (out->curve_count < ALE_MAX_CURVES) {
                ale_curve_fit(e, e->run[k], &out->curve[out->curve_count++]);
            }
            continue;
        }
        ale_line_t line;
        const ale_run_t run = e->run[k];
        ale_line_fit(e, run, &line);
        if (!is_line(e, run, &line)) {
            continue;
        }
        if (out->line_count == ALE_MAX_LINES) {
            e->refused[ALE_REFUSED_CAPACITY]++;
            continue;
        }
        line.first_end = end_kind(e, run.first, run.first - 1);
        line.last_end = end_kind(e, run.last, run.last + 1);
        out->line[out->line_count++] = line;
    }
}

__attribute__((noinline)) void ale_extract_scan(ale_extractor_t *e, const ale_scan_t *scan,
                                                const uint32_t *bearing_bam, ale_features_t *out)
{
    memset(e->refused, 0, sizeof e->refused);
    out->line_count = 0;
    out->curve_count = 0;
    ale_points_list(e, scan);
    ale_scan_noise_measure(e, scan);
    ale_outlier_remove_spikes(e);
    ale_segment(e, scan);
    ale_outlier_remove(e);
    ale_segment(e, scan);
    ale_points_place(e, scan, bearing_bam);
    ale_stage_end(&e->hook, ALE_STAGE_SMOOTH);
    ale_moments_build(e);
    e->shared_prior_mm2_q36 = e->noise.shared_mm2_q36;
    e->shared_prior_relative_q36 = e->noise.shared_relative_q36;
    e->noise.shared_mm2_q36 *= 2;
    e->noise.shared_relative_q36 *= 2;
    search_all(e);
    ale_scan_noise_measure_shared(e, scan);
    search_all(e);
    ale_merge_runs(e);
    place_breaks(e);
    ale_curve_find(e);
    split_runs(e);
    ale_merge_runs(e);
    place_breaks(e);
    ale_curve_find(e);
    write_lines(e, out);
    ale_corner_find(out);
    out->outliers = e->outliers;
    memcpy(out->refused, e->refused, sizeof out->refused);
    ale_stage_end(&e->hook, ALE_STAGE_EXTRACT);
}
