/* The runs of a scan, of which nothing is known but what the headers of lib/extract say of the fields; not
 * even that a run's last point lies behind its first. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_RUNS_H
#define ALE_PROOFS_EVA_UNKNOWN_RUNS_H

#include "extract/run_list.h"
#include "unknown_points.h"

/* What a part of the extraction begins with; what it adds is far less. */
#define MOST_COUNTED (1 << 20)
#define MOST_CHI_Q8 (1 << 19)

static inline ale_run_fit_t unknown_fit(int32_t fewest)
{
    return (ale_run_fit_t){
        .n = (int32_t)unknown(fewest, ALE_MAX_BEAMS),
        .sse_q8 = unknown(0, INT64_C(1) << 51),
        .var_q8 = unknown(1, INT64_C(1) << 36),
        .shared_q8 = unknown(0, INT64_C(1) << 35),
    };
}

static inline ale_run_t unknown_run(void)
{
    return (ale_run_t){
        .first = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1),
        .last = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1),
        .curved = unknown(0, 1),
        .no_arc = unknown(0, 1),
        .no_break = unknown(0, 1),
        .no_curve = unknown(0, 1),
        .settled = unknown(0, 1),
        .fit = unknown_fit(0),
    };
}

static inline void unknown_run_list(ale_run_list_t *list)
{
    unknown_points(&list->scan.points);
    unknown_noise(&list->scan.noise);
    unknown_segments(&list->scan.segments);
    list->min_points = (uint16_t)unknown(ALE_MIN_RUN, ALE_MAX_BEAMS);
    list->search_fits = (int32_t)unknown(0, MOST_COUNTED);
    list->effort = (int32_t)unknown(0, MOST_COUNTED);
    list->count = (uint16_t)unknown(0, ALE_MAX_RUNS);
    //@ loop unroll 1;
    for (uint32_t n = 0; n <= ALE_MAX_BEAMS; n++) {
        list->chi_low_q8[n] = (int32_t)unknown(0, MOST_CHI_Q8);
        list->chi_high_q8[n] = (int32_t)unknown(0, MOST_CHI_Q8);
    }
    //@ loop unroll 1;
    for (uint32_t k = 0; k < ALE_MAX_RUNS; k++) {
        list->run[k] = unknown_run();
    }
}

#endif
