#include "observe/observation.h"

#include "base/fixed.h"
#include "base/trig.h"

/* No wall is known better than this from one scan: paint, skirting boards, warped boards. */
enum { OFFSET_FLOOR_UM2 = 250000, ANGLE_FLOOR_URAD2 = 40000, NRAD_PER_RAD = 1000000000 };

static ale_point_t in_direction(int64_t length_um, ale_direction_t d)
{
    return (ale_point_t){(int32_t)ale_round_shift(length_um * d.cos_q30, 30),
                         (int32_t)ale_round_shift(length_um * d.sin_q30, 30)};
}

ale_point_t ale_polar(int64_t length_um, uint32_t direction_bam)
{
    return in_direction(length_um, ale_direction(direction_bam));
}

static int64_t component(ale_point_t v, ale_direction_t d)
{
    return ale_round_shift((int64_t)v.x_um * d.cos_q30 + (int64_t)v.y_um * d.sin_q30, 30);
}

int64_t ale_along(ale_point_t v, uint32_t direction_bam)
{
    return component(v, ale_direction(direction_bam));
}

ale_observation_t ale_observation_from(const ale_observation_t *observation, const ale_viewpoint_t *viewpoint)
{
    ale_observation_t moved = *observation;
    moved.centre = ale_point_from(observation->centre, viewpoint);
    moved.normal_bam = observation->normal_bam + viewpoint->pose.theta_bam;
    return moved;
}

/* Position along the line, from the foot of the normal, where offset and angle are uncorrelated. */
static int64_t centre_of(const ale_line_t *line, int64_t from_um, int64_t to_um)
{
    if (line->var_alpha_nrad2 <= 0) {
        return (from_um + to_um) / 2;
    }
    const int64_t t_um = ale_mul_div(line->cov_alpha_rho, NRAD_PER_RAD, line->var_alpha_nrad2);
    return ale_clamp64(t_um, ale_min64(from_um, to_um), ale_max64(from_um, to_um));
}

static void observation_of(const ale_line_t *line, const ale_scan_t *scan, const ale_viewpoint_t *sensor,
                           int64_t systematic_um, ale_observation_t *out)
{
    const ale_direction_t along = ale_direction(line->alpha_bam + ALE_BAM_QUARTER_TURN);
    const int64_t a_um = component(line->start, along);
    const int64_t b_um = component(line->end, along);
    const bool forward = a_um <= b_um;
    const int64_t centre_um = centre_of(line, a_um, b_um);
    const ale_point_t foot = ale_polar(line->rho_um, line->alpha_bam);
    const ale_point_t centre = ale_plus(foot, in_direction(centre_um, along));
    const int32_t first_us = ale_scan_beam_offset_us(scan, line->first);
    const int32_t last_us = ale_scan_beam_offset_us(scan, line->last);
    const int64_t var_um2 = line->var_rho_um2 - ale_mul_div(centre_um, line->cov_alpha_rho, NRAD_PER_RAD);
    out->centre = ale_point_from(centre, sensor);
    out->normal_bam = line->alpha_bam + ALE_BAM_HALF_TURN + sensor->pose.theta_bam;
    out->start_um = (int32_t)((forward ? a_um : b_um) - centre_um);
    out->end_um = (int32_t)((forward ? b_um : a_um) - centre_um);
    out->start_time_us = forward ? first_us : last_us;
    out->end_time_us = forward ? last_us : first_us;
    out->start_end = forward ? line->first_end : line->last_end;
    out->end_end = forward ? line->last_end : line->first_end;
    const int64_t length_mm = ale_max64(ale_observation_length_um(out) / 1000, 10);
    const int64_t bend_urad = systematic_um * 4000 / length_mm;
    out->var_offset_um2 = ale_max64(var_um2, 0) + OFFSET_FLOOR_UM2 + systematic_um * systematic_um;
    out->var_angle_urad2 = line->var_alpha_nrad2 / 1000000 + ANGLE_FLOOR_URAD2 + bend_urad * bend_urad;
}

uint32_t ale_observe_lines(const ale_features_t *features, const ale_scan_t *scan, ale_pose_t sensor,
                           int32_t systematic_um, ale_observation_t out[ALE_MAX_OBSERVATIONS])
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(sensor);
    uint32_t count = 0;
    for (uint32_t i = 0; i < features->line_count; i++) {
        if (ale_is_chosen(i, features->line_count, ALE_MAX_OBSERVATIONS)) {
            observation_of(&features->line[i], scan, &viewpoint, systematic_um, &out[count]);
            out[count].first_beam = features->line[i].first;
            out[count].last_beam = features->line[i].last;
            out[count++].kind = ALE_OBSERVATION_LINE;
        }
    }
    return count;
}

int64_t ale_observations_length_um(const ale_observation_t observation[], uint32_t count)
{
    int64_t sum_um = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum_um += ale_observation_length_um(&observation[i]);
    }
    return sum_um;
}
