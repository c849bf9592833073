#include "track/pipeline_config.h"

#include "motion/wheel_factors.h"

ale_pipeline_config_t ale_pipeline_default_config(void)
{
    return (ale_pipeline_config_t){
        .extract = ale_extract_default_config(),
        .use_odometry = true,
        .odometry_distance_factor_ppm = ALE_WHEEL_FACTOR_ONE,
        .odometry_turn_factor_ppm = ALE_WHEEL_FACTOR_ONE,
        .odometry_scale_ppm = 50000,
        .odometry_turn_urad_m = 35000,
        .odometry_turn_ppm = 20000,
        .max_speed_mm_s = 3000,
        .max_turn_mrad_s = 6000,
    };
}

bool ale_pipeline_config_is_valid(const ale_pipeline_config_t *c)
{
    const struct {
        int32_t value;
        int32_t least;
        int32_t most;
    } range[] = {
        {c->odometry_distance_factor_ppm, ALE_WHEEL_FACTOR_ONE / 2, 2 * ALE_WHEEL_FACTOR_ONE},
        {c->odometry_turn_factor_ppm, ALE_WHEEL_FACTOR_ONE / 2, 2 * ALE_WHEEL_FACTOR_ONE},
        {c->odometry_turn_bias_urad_m, -1000000, 1000000},
        {c->odometry_scale_ppm, 0, 500000},
        {c->odometry_turn_urad_m, 0, 1000000},
        {c->odometry_turn_ppm, 0, 500000},
        {c->odometry_lag_us, -100000, 300000},
        {c->max_speed_mm_s, 1, 50000},
        {c->max_turn_mrad_s, 1, 50000},
    };
    for (unsigned i = 0; i < sizeof range / sizeof range[0]; i++) {
        if (range[i].value < range[i].least || range[i].value > range[i].most) {
            return false;
        }
    }
    return c->blind_count <= ALE_MAX_BLIND_SECTORS;
}
