#include "motion/wheel_factors.h"

#include "base/fixed.h"
#include "base/trig.h"

static const int64_t bam_a_turn = (int64_t)1 << 32;
static const int64_t nrad_a_turn = 6283185307;

void ale_wheel_factors_init(ale_wheel_factors_t *factors, int32_t distance_ppm, int32_t turn_ppm,
                            int32_t bias_urad_m)
{
    *factors =
        (ale_wheel_factors_t){.distance_ppm = distance_ppm, .turn_ppm = turn_ppm, .bias_urad_m = bias_urad_m};
}

static bool changes_nothing(const ale_wheel_factors_t *f)
{
    return f->distance_ppm == ALE_WHEEL_FACTOR_ONE && f->turn_ppm == ALE_WHEEL_FACTOR_ONE &&
           f->bias_urad_m == 0;
}

/* Turn of a step of the way, BAM; half a turn of the counter is the most that a step can be. */
static int64_t corrected_turn_bam(const ale_wheel_factors_t *f, int32_t counted_bam, int64_t way_um)
{
    const int64_t bias_nrad = ale_round_div(way_um * f->bias_urad_m, 1000);
    const int64_t turn_bam = counted_bam - ale_mul_div(bias_nrad, bam_a_turn, nrad_a_turn);
    return ale_mul_div(turn_bam, f->turn_ppm, ALE_WHEEL_FACTOR_ONE);
}

static uint32_t angle(int64_t bam)
{
    return (uint32_t)(uint64_t)bam;
}

ale_pose_t ale_wheel_factors_correct(ale_wheel_factors_t *factors, ale_pose_t counted)
{
    if (!factors->begun || changes_nothing(factors)) {
        factors->begun = true;
        factors->counted = factors->corrected = counted;
        return counted;
    }
    const ale_pose_t step = ale_pose_between(factors->counted, counted);
    const int32_t counted_turn_bam = (int32_t)step.theta_bam;
    /* the chord of an arc lies half of its turn beside the heading at its beginning */
    const ale_point_t chord =
        ale_rotate((ale_point_t){step.x_um, step.y_um}, 0u - angle(counted_turn_bam / 2));
    const int64_t turn_bam = corrected_turn_bam(factors, counted_turn_bam, chord.x_um);
    const ale_direction_t along = ale_direction(factors->corrected.theta_bam + angle(turn_bam / 2));
    const int64_t x_um = ale_mul_div(chord.x_um, factors->distance_ppm, ALE_WHEEL_FACTOR_ONE);
    const int64_t y_um = ale_mul_div(chord.y_um, factors->distance_ppm, ALE_WHEEL_FACTOR_ONE);
    const int64_t to_x_um =
        factors->corrected.x_um + ale_round_shift(along.cos_q30 * x_um - along.sin_q30 * y_um, 30);
    const int64_t to_y_um =
        factors->corrected.y_um + ale_round_shift(along.sin_q30 * x_um + along.cos_q30 * y_um, 30);
    factors->counted = counted;
    factors->corrected =
        ale_abs64(to_x_um) <= INT32_MAX && ale_abs64(to_y_um) <= INT32_MAX
            ? (ale_pose_t){(int32_t)to_x_um, (int32_t)to_y_um, factors->corrected.theta_bam + angle(turn_bam)}
            : counted;
    return factors->corrected;
}
