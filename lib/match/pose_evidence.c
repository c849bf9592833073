#include "match/pose_evidence.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "map/visibility.h"

enum {
    SURFACE_MOST_UM = 1500000, /* that one surface counts for */
    SIGMAS_MOST = 5,           /* a prediction weighs no more than at so many */
    SIGMA_UM = ALE_EVIDENCE_AGAINST_UM / (SIGMAS_MOST * SIGMAS_MOST) /* of surface, at one */
};

static int64_t bounded(int64_t length_um)
{
    return ale_min64(length_um, SURFACE_MOST_UM);
}

static int64_t explained_um(const ale_scene_t *scene, const ale_fit_t *fit)
{
    int64_t sum_um = 0;
    for (uint32_t i = 0; i < scene->observation_count; i++) {
        const ale_association_t *association = &fit->association[i];
        if (association->wall != ALE_NO_WALL || association->landmark != ALE_NO_LANDMARK) {
            sum_um += bounded(ale_observation_length_um(&scene->observation[i]));
        }
    }
    return sum_um;
}

static int64_t looked_through_um(const ale_local_map_t *map, const ale_posed_scan_t *from)
{
    const int64_t farthest_um = ale_farthest_um(from->scan);
    int64_t sum_um = 0;
    uint32_t asked = 0;
    for (uint32_t n = 0; n < map->near_first[ALE_MAP_DIRECTIONS] && asked < ALE_EVIDENCE_WALLS; n++) {
        const ale_wall_t *wall = &map->wall[map->near[n]];
        if (!ale_wall_may_be_in_view(wall, from->sensor, farthest_um)) {
            continue;
        }
        asked++;
        const ale_points_visibility_t seen =
            ale_wall_points_visibility(wall, from, (ale_slack_t){0, 0, false});
        if (seen.violated > seen.supported) {
            sum_um += bounded(wall->end_um - wall->start_um) * seen.violated / ALE_VISIBILITY_POINTS;
        }
    }
    return sum_um;
}

int64_t ale_pose_evidence_um(const ale_scene_t *scene, const ale_fit_t *fit, const ale_posed_scan_t *from)
{
    return explained_um(scene, fit) - looked_through_um(scene->map, from);
}

int64_t ale_pose_against_um(const ale_motion_t *predicted, ale_pose_t pose)
{
    const ale_pose_t off = ale_pose_between(predicted->pose, pose);
    const int64_t apart[ALE_AXES] = {off.x_um, off.y_um, ale_bam_to_nrad((int32_t)off.theta_bam) / 1000};
    int64_t most_um = 0;
    for (int i = 0; i < ALE_AXES; i++) {
        const int64_t sigma = ale_max64(ale_matrix_sigma(&predicted->cov, i), 1);
        const int64_t sigmas_q8 = ale_min64(ale_abs64(apart[i]) * 256 / sigma, (int64_t)SIGMAS_MOST * 256);
        most_um = ale_max64(most_um, SIGMA_UM * sigmas_q8 * sigmas_q8 >> 16);
    }
    return most_um;
}
