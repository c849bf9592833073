#include "scanner/urg/scan_fill.h"

#include "base/fixed.h"

enum { TWO_CHARACTERS_END_MM = 4095, LEAST_RANGE_MM = 20, MOST_RANGE_MM = ALE_MAX_RANGE_UM / 1000 };

static const int64_t turn_bam = INT64_C(1) << 32;

static int32_t clamp_mm(int32_t mm)
{
    return (int32_t)ale_clamp64(mm, LEAST_RANGE_MM, MOST_RANGE_MM);
}

void ale_urg_fill_scan(const ale_urg_geometry_t *geometry, const ale_scip_event_t *event, int64_t stamp_us,
                       int32_t period_us, bool reversed, ale_scan_t *scan)
{
    const int32_t cluster = event->request.cluster > 1 ? event->request.cluster : 1;
    const int64_t steps = geometry->steps_per_turn;
    const int32_t sign = reversed ? -1 : 1;
    /* Middle of the first beam, in half steps from step 0. */
    const int32_t middle = 2 * event->request.first_step + cluster - 1;
    const int64_t bearing_bam = ale_round_div((middle - 2 * geometry->front_step) * turn_bam, 2 * steps);

    scan->stamp_beam = -(middle / (2 * cluster));
    scan->stamp_us = stamp_us + ale_round_div((int64_t)(middle % (2 * cluster)) * period_us, 2 * steps);
    scan->beam_time_ns =
        (int32_t)ale_min64(ale_round_div((int64_t)period_us * 1000 * cluster, steps), INT32_MAX);
    scan->first_bearing_bam = (uint32_t)(sign * bearing_bam);
    scan->step_bam = (int32_t)(sign * ale_round_div(cluster * turn_bam, steps));
    scan->range_min_um = clamp_mm(geometry->range_min_mm) * 1000;
    scan->range_max_um =
        clamp_mm(event->request.characters == 2 && geometry->range_max_mm > TWO_CHARACTERS_END_MM
                     ? TWO_CHARACTERS_END_MM
                     : geometry->range_max_mm) *
        1000;
    scan->beams = (uint16_t)event->value_count;
    for (uint16_t k = 0; k < scan->beams; k++) {
        ale_scan_set_urg(scan, k, event->values[k]);
    }
}
