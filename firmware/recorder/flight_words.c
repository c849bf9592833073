#include "recorder/flight_words.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char *const stage_names[ALE_STAGES] = {"deskew", "smooth", "extract", "match", "map"};

ale_flight_result_t ale_flight_result(const ale_result_t *result)
{
    ale_flight_result_t kept = {
        .estimate = result->estimate,
        .first_beam_us = result->first_beam_us,
        .arrival_us = result->arrival_us,
        .total_ns = result->total_ns,
        .overloaded = result->overloaded,
        .late = result->late,
        .odometry_taken = result->odometry_taken,
        .lines = result->has_scan ? result->features.line_count : 0,
        .corners = result->has_scan ? result->features.corner_count : 0,
    };
    memcpy(kept.stage_ns, result->stage_ns, sizeof kept.stage_ns);
    memcpy(kept.stage_start_ns, result->stage_start_ns, sizeof kept.stage_start_ns);
    memcpy(kept.stage_end_ns, result->stage_end_ns, sizeof kept.stage_end_ns);
    return kept;
}

uint32_t ale_flight_decision(const ale_flight_result_t *result, char text[ALE_FLIGHT_MAX_PAYLOAD])
{
    const ale_estimate_t *e = &result->estimate;
    const int length = snprintf(
        text, ALE_FLIGHT_MAX_PAYLOAD,
        "scan=%" PRIu32 " stamp_us=%" PRId64 " state=%u predicted=%d lines=%u corners=%u"
        " matched_lines=%u matched_corners=%u x_um=%" PRId32 " y_um=%" PRId32 " theta_bam=%" PRIu32
        " map_x_um=%" PRId32 " map_y_um=%" PRId32 " map_theta_bam=%" PRIu32 " var_xx_um2=%" PRId64
        " var_yy_um2=%" PRId64 " var_tt_nrad2=%" PRId64 " lag_us=%" PRId32 " odometry=%" PRIu32
        " overloaded=%" PRIu32 " late=%" PRIu32 " map_id=%" PRIu32
        " maps=%u wheel_fault=%u wheel_faults=%" PRIu32 "\n",
        e->scan, e->stamp_us, e->state, e->predicted, result->lines, result->corners, e->matched_lines,
        e->matched_corners, e->smooth.x_um, e->smooth.y_um, e->smooth.theta_bam, e->map.x_um, e->map.y_um,
        e->map.theta_bam, e->cov[0], e->cov[4], e->cov[8], e->lag_us, result->odometry_taken,
        result->overloaded, result->late, e->map_id, e->maps, e->wheel_fault, e->wheel_faults);
    return (uint32_t)length;
}

uint32_t ale_flight_stages(const ale_flight_result_t *result, char text[ALE_FLIGHT_MAX_PAYLOAD])
{
    int length =
        snprintf(text, ALE_FLIGHT_MAX_PAYLOAD,
                 "scan=%" PRIu32 " first_beam_us=%" PRId64 " arrival_us=%" PRId64 " total_ns=%" PRId32,
                 result->estimate.scan, result->first_beam_us, result->arrival_us, result->total_ns);
    for (int k = 0; k < ALE_STAGES; k++) {
        length += snprintf(text + length, ALE_FLIGHT_MAX_PAYLOAD - (size_t)length,
                           " %s_ns=%" PRId32 " %s_start_ns=%" PRId32 " %s_end_ns=%" PRId32, stage_names[k],
                           result->stage_ns[k], stage_names[k], result->stage_start_ns[k], stage_names[k],
                           result->stage_end_ns[k]);
    }
    length += snprintf(text + length, ALE_FLIGHT_MAX_PAYLOAD - (size_t)length, "\n");
    return (uint32_t)length;
}
