#include "track/step_filter.h"

#include <string.h>

#include "base/fixed.h"

enum {
    KNOWN_UM = 60000, /* two sigmas of the pose up to which an earlier scan tells what has come */
    KNOWN_URAD = 30000
};

ale_pose_t ale_pipeline_smooth_pose(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose)
{
    return ale_pose_compose(p->smooth.pose, ale_pose_between(before, pose));
}

ale_seen_t ale_pipeline_seen_from(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose)
{
    const ale_pose_t robot = ale_pipeline_smooth_pose(p, before, pose);
    return (ale_seen_t){.posed = {&p->still.scan, ale_observed_bearings(&p->observed),
                                  ale_pose_compose(robot, p->config.sensor)},
                        .robot = robot,
                        .observation = p->still.observation,
                        .observation_count = p->still.count};
}

void ale_filter_clear(ale_pipeline_t *p)
{
    ale_witness_clear(&p->witness);
    ale_carried_clear(&p->carried);
    ale_elders_clear(&p->elders);
    ale_way_back_clear(&p->way_back);
    ale_zero_motion_clear(&p->zero_motion);
    p->still.count = 0;
}

void ale_filter_mask(ale_pipeline_t *p, ale_scan_t *scan)
{
    ale_carried_mask(&p->carried, scan);
}

void ale_filter_begin(ale_pipeline_t *p)
{
    p->still.scan = p->observed.scan;
    p->still.count = p->observed.count;
    memcpy(p->still.observation, p->observed.observation, p->still.count * sizeof p->still.observation[0]);
}

void ale_filter_attached(ale_pipeline_t *p, ale_pose_t before, ale_fit_t *fit)
{
    const ale_seen_t earlier = ale_witness_seen(&p->witness);
    const ale_seen_t now = ale_pipeline_seen_from(p, before, fit->motion.pose);
    const ale_matrix_t *cov = &fit->motion.cov;
    const bool known = 2 * ale_max64(ale_matrix_sigma(cov, 0), ale_matrix_sigma(cov, 1)) < KNOWN_UM &&
                       2 * ale_matrix_sigma(cov, 2) < KNOWN_URAD;
    if (earlier.observation_count > 0 && known) {
        p->still.count = ale_carried_notice(&p->carried, &earlier, &now, &p->still.scan, p->still.observation,
                                            fit->association);
    }
}

bool ale_filter_keep(ale_pipeline_t *p, ale_pose_t before, const ale_motion_t *found)
{
    const ale_seen_t now = ale_pipeline_seen_from(p, before, found->pose);
    if (p->still.count == 0) {
        return false;
    }
    ale_witness_keep(&p->witness, &now);
    ale_carried_show(&p->carried, &p->witness.seen.scan);
    return true;
}

void ale_filter_newcomers(ale_pipeline_t *p, ale_pose_t before, bool good, ale_fit_t *fit)
{
    const ale_seen_t now = ale_pipeline_seen_from(p, before, fit->motion.pose);
    ale_zero_motion_update(&p->zero_motion, now.robot);
    p->still.count =
        ale_elders_drop_newcomers(&p->elders, &p->map, &now, ale_zero_motion_is_long(&p->zero_motion),
                                  p->still.observation, fit->association);
    const bool copied = good && ale_elders_keep(&p->elders, &now);
    if (good && !copied && p->atlas.current != ALE_FIRST_MAP) {
        ale_way_back_keep(&p->way_back, &now); /* or the next one: one copy is enough for a scan */
    }
}

void ale_filter_set_pose(ale_pipeline_t *p, ale_pose_t robot)
{
    ale_witness_stand(&p->witness, robot, ale_pose_compose(robot, p->config.sensor));
}
