#include "track/maps.h"

#include "track/correction.h"
#include "track/step_filter.h"
#include "track/step_update.h"

enum {
    CLAIM_SCANS = 100,        /* that may still show that the robot is where it is said to be */
    SHOWN_LEAST_UM = 1500000, /* surfaces that the next scan will find again */
    ORIGIN_SIGMA_UM = 1,      /* of the pose to the walls that are born from it */
    ORIGIN_SIGMA_URAD = 1
};

bool ale_maps_is_home(const ale_pipeline_t *p)
{
    return p->atlas.current == ALE_FIRST_MAP;
}

void ale_maps_lose(ale_pipeline_t *p, ale_claim_t claim)
{
    p->monitor.state = ALE_STATE_LOST;
    p->next_claim = claim;
    p->broken = true;
}

bool ale_maps_may_begin(const ale_pipeline_t *p)
{
    return ale_observations_length_um(p->observed.observation, p->observed.count) > SHOWN_LEAST_UM;
}

void ale_maps_begin(ale_pipeline_t *p)
{
    const uint8_t number = ale_atlas_begin(&p->atlas);
    ale_local_map_give_up(&p->map, number);
    ale_local_map_select(&p->map, number);
    ale_motion_widen(&p->motion, ORIGIN_SIGMA_UM, ORIGIN_SIGMA_URAD);
    ale_tracking_init(&p->monitor);
    ale_filter_clear(p);
    ale_filter_begin(p);
    ale_relocation_clear(&p->relocation);
    ale_update_restart(p);
    p->claim = p->next_claim;
    p->claims = p->claim == ALE_CLAIM_NONE ? 0 : CLAIM_SCANS;
    p->next_claim = ALE_CLAIM_NEAR;
    p->speed_known = false;
    p->watched = p->motion;
    p->begun = p->scans;
    p->unconfirmed_from = 0;
    p->broken = true;
}

/* The robot is in an older map again. */
static void arrive(ale_pipeline_t *p, uint8_t map)
{
    ale_local_map_select(&p->map, map);
    ale_relocation_clear(&p->relocation);
    ale_tracking_found(&p->monitor);
    ale_update_restart(p);
    p->claims = 0;
    p->joined = true;
}

void ale_maps_join(ale_pipeline_t *p, uint8_t into, const ale_fit_t *fit)
{
    const ale_map_uncertainty_t exact = {0};
    const ale_pose_t shift = ale_pose_shift(p->motion.pose, fit->motion.pose);
    const ale_map_uncertainty_t there =
        ale_map_uncertainty_here(&p->map, p->observed.observation, p->observed.count, fit, &exact);
    const ale_local_map_join_t join = {p->atlas.current, into, shift, there};
    p->moved_map = (ale_moved_map_t){p->begun, p->scans, shift};
    p->begun = 0;
    if (p->frozen) {
        ale_local_map_give_up(&p->map, join.from);
    }
    ale_local_map_join(&p->map, &join, &p->spare_landmarks);
    ale_atlas_join(&p->atlas, into, shift);
    p->motion = fit->motion;
    p->watched = p->motion;
    ale_smooth_hold(&p->smooth, p->motion.pose);
    ale_lag_turn(&p->lag, shift.theta_bam);
    p->moved = true;
    arrive(p, into);
    p->map_uncertainty = there;
}

void ale_maps_joined(ale_pipeline_t *p, uint32_t map_id, uint32_t into_map_id)
{
    const int32_t from = ale_atlas_find(&p->atlas, map_id);
    const int32_t into = ale_atlas_find(&p->atlas, into_map_id);
    if (from == ALE_NO_MAP || into == ALE_NO_MAP) {
        return;
    }
    const ale_local_map_join_t join = {(uint8_t)from, (uint8_t)into, {0, 0, 0}, p->map_uncertainty};
    ale_local_map_join(&p->map, &join, &p->spare_landmarks);
    const bool is_there = p->atlas.current == from;
    ale_atlas_absorb(&p->atlas, join.from, join.into);
    if (is_there) {
        arrive(p, join.into);
    }
}
