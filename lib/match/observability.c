#include "match/observability.h"

#include "base/fixed.h"
#include "base/trig.h"

enum { DEGENERATE_UM = 200000, WEIGHT_BITS = 20 };

/* Information of the place, map frame, 1/mm^2 in Q20. */
typedef struct {
    int64_t xx;
    int64_t xy;
    int64_t yy;
    int64_t bias_x;
    int64_t bias_y;
} information_t;

static void add(information_t *sum, int64_t x_q30, int64_t y_q30, int64_t var_um2, int64_t scale_error_um)
{
    const int64_t weight = ((int64_t)1000000 << WEIGHT_BITS) / ale_max64(var_um2, ALE_ROW_VAR_MIN_UM2);
    const int64_t x_q14 = ale_round_shift(x_q30, 16);
    const int64_t y_q14 = ale_round_shift(y_q30, 16);
    sum->xx += ale_round_shift(weight * x_q14 * x_q14, 28);
    sum->xy += ale_round_shift(weight * x_q14 * y_q14, 28);
    sum->yy += ale_round_shift(weight * y_q14 * y_q14, 28);
    sum->bias_x += ale_mul_shift(weight * x_q14, scale_error_um, 14);
    sum->bias_y += ale_mul_shift(weight * y_q14, scale_error_um, 14);
}

/* Whether every direction is determined to better than one sigma. */
static bool determines(const information_t *sum, int64_t sigma_um)
{
    const int64_t least = ((int64_t)1000000 << WEIGHT_BITS) / (sigma_um * sigma_um);
    const int64_t xx = sum->xx - least;
    const int64_t yy = sum->yy - least;
    return xx > 0 && yy > 0 && xx * yy > sum->xy * sum->xy;
}

static void add_walls(const ale_local_map_t *map, const ale_observation_t observation[], uint32_t count,
                      const ale_fit_t *fit, information_t *sum)
{
    for (uint32_t i = 0; i < count; i++) {
        const ale_association_t *association = &fit->association[i];
        if (association->wall != ALE_NO_WALL) {
            const ale_wall_t *wall = &map->wall[association->wall];
            add(sum, wall->normal_x_q30, wall->normal_y_q30,
                ale_wall_offset_var(wall, association->error.t_um) + observation[i].var_offset_um2,
                wall->scale_error_um);
        }
    }
}

/* Variance that the unknown position along a surface adds across the landmark: its length, times the angle
 * between the two. */
static int64_t along_var_um2(const ale_observation_t *observation, int64_t turned_q30)
{
    const int64_t length_mm = ale_observation_length_um(observation) / 1000;
    const int64_t turned_mrad = ale_round_shift(turned_q30 * 1000, 30);
    return length_mm * length_mm * (turned_mrad * turned_mrad + observation->var_angle_urad2 / 1000000);
}

static void add_landmarks(const ale_local_map_t *map, const ale_observation_t observation[], uint32_t count,
                          const ale_fit_t *fit, information_t *sum)
{
    for (uint32_t i = 0; i < count; i++) {
        const ale_association_t *association = &fit->association[i];
        if (association->wall != ALE_NO_WALL || association->landmark == ALE_NO_LANDMARK ||
            map->landmarks.landmark[association->landmark].seen < ALE_LANDMARK_CONFIRMED) {
            continue;
        }
        const ale_landmark_t *landmark = &map->landmarks.landmark[association->landmark];
        const ale_direction_t normal = ale_direction(landmark->normal_bam);
        const uint32_t turned_bam =
            observation[i].normal_bam + fit->motion.pose.theta_bam - landmark->normal_bam;
        add(sum, normal.cos_q30, normal.sin_q30,
            landmark->var_um2 + observation[i].var_offset_um2 +
                along_var_um2(&observation[i], ale_sin_q30(turned_bam)),
            0);
    }
}

ale_observability_t ale_observability_of(const ale_local_map_t *map, const ale_observation_t observation[],
                                         uint32_t count, const ale_fit_t *fit)
{
    information_t sum = {0, 0, 0, 0, 0};
    add_walls(map, observation, count, fit, &sum);
    const information_t walls = sum;
    if (!determines(&sum, ALE_DETERMINED_UM)) {
        add_landmarks(map, observation, count, fit, &sum);
    }
    return (ale_observability_t){.determined = determines(&sum, ALE_DETERMINED_UM),
                                 .degenerate = !determines(&sum, DEGENERATE_UM),
                                 .along_bam =
                                     ale_atan2_bam(2 * sum.xy, sum.xx - sum.yy) / 2 + ALE_BAM_QUARTER_TURN,
                                 .xx_q20 = walls.xx,
                                 .xy_q20 = walls.xy,
                                 .yy_q20 = walls.yy,
                                 .bias_x_q20 = walls.bias_x,
                                 .bias_y_q20 = walls.bias_y};
}
