#include "settings.h"

#include <cmath>
#include <iterator>
#include <type_traits>

#include "units.h"

namespace ale::binding
{

namespace
{

/* A number kept as an integer, so many to one of the setting's unit. */
#define NUMBER(name, member, per_unit, least, most)                                                          \
    {                                                                                                        \
        name, least, most,                                                                                   \
            [](const ale_pipeline_config_t &config) {                                                        \
                return static_cast<double>(config.member) / (per_unit);                                      \
            },                                                                                               \
            [](ale_pipeline_config_t &config, double value) {                                                \
                config.member = static_cast<std::remove_reference_t<decltype(config.member)>>(               \
                    std::llround(value * (per_unit)));                                                       \
            }                                                                                                \
    }

constexpr double pi = 3.141592653;

double get_theta(const ale_pipeline_config_t &config)
{
    return radians(config.sensor.theta_bam);
}

void set_theta(ale_pipeline_config_t &config, double value)
{
    config.sensor.theta_bam = bam_of(value);
}

double get_use(const ale_pipeline_config_t &config)
{
    return config.use_odometry ? 1 : 0;
}

void set_use(ale_pipeline_config_t &config, double value)
{
    config.use_odometry = value != 0;
}

} // namespace

const Setting settings[] = {
    NUMBER("sensor.x", sensor.x_um, micro, -10, 10),
    NUMBER("sensor.y", sensor.y_um, micro, -10, 10),
    {"sensor.theta", -pi, pi, get_theta, set_theta},
    NUMBER("noise.own_um", extract.noise.own_um, 1, 0, 100000),
    NUMBER("noise.own_ppm", extract.noise.own_ppm, 1, 0, 100000),
    NUMBER("noise.own_ppm_per_m", extract.noise.own_ppm_per_m, 1, 0, 10000),
    NUMBER("noise.shared_um", extract.noise.shared_um, 1, 0, 100000),
    NUMBER("noise.shared_ppm", extract.noise.shared_ppm, 1, 0, 100000),
    NUMBER("noise.shared_beams", extract.noise.shared_beams, 1, 1, ALE_MAX_BEAMS),
    NUMBER("noise.surface_um", extract.noise.surface_um, 1, 0, 100000),
    NUMBER("noise.bearing_nrad", extract.noise.bearing_nrad, 1, 0, 100000000),
    NUMBER("extract.min_points", extract.min_points, 1, 5, ALE_MAX_BEAMS),
    NUMBER("extract.min_length", extract.min_length_um, micro, 0, 100),
    NUMBER("extract.smooth_span", extract.smooth_span, 1, 1, 31),
    NUMBER("extract.robust_passes", extract.robust_passes, 1, 0, 8),
    {"odometry.use", 0, 1, get_use, set_use},
    NUMBER("odometry.lag_us", odometry_lag_us, 1, -100000, 300000),
    NUMBER("odometry.distance_factor", odometry_distance_factor_ppm, micro, 0.5, 2),
    NUMBER("odometry.turn_factor", odometry_turn_factor_ppm, micro, 0.5, 2),
    NUMBER("odometry.turn_bias", odometry_turn_bias_urad_m, micro, -1, 1),
    NUMBER("odometry.scale", odometry_scale_ppm, micro, 0, 0.5),
    NUMBER("odometry.turn_per_metre", odometry_turn_urad_m, micro, 0, 1),
    NUMBER("odometry.turn_scale", odometry_turn_ppm, micro, 0, 0.5),
    NUMBER("robot.max_speed", max_speed_mm_s, 1000, 0.01, 20),
    NUMBER("robot.max_turn", max_turn_mrad_s, 1000, 0.01, 20),
};
const size_t setting_count = std::size(settings);

ale_pipeline_config_t config_of(const ale_binding_config_t &asked)
{
    ale_pipeline_config_t config = ale_pipeline_default_config();
    for (size_t i = 0; i < setting_count; i++) {
        settings[i].set(config, asked.settings[i]);
    }
    config.blind_count = asked.blind_count;
    for (uint32_t i = 0; i < asked.blind_count && i < ALE_MAX_BLIND_SECTORS; i++) {
        const double *sector = asked.blind_rad + size_t{2} * i;
        config.blind[i] = {bam_of(sector[0]), bam_of(sector[1])};
    }
    return config;
}

} // namespace ale::binding
