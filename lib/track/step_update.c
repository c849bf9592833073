#include "track/step_update.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "track/map_update.h"
#include "track/step_associate.h"
#include "track/step_observe.h"

enum {
    LEARN_DETERMINED_UM = 10000, /* scans that know the displacement well enough to teach the wheels */
    LEARN_LAG_VAR_UM2 = 4000000, /* and a lag that could not have made (2 mm)^2 of it */
    REANCHOR_SIGMA_UM = 1000,    /* of the pose to the walls that are born from it */
    REANCHOR_SIGMA_URAD = 500
};

void ale_update_uncertainty(ale_pipeline_t *p, const ale_prediction_t *prediction, const ale_ways_t *ways,
                            const ale_observability_t *observability, const ale_fit_t *fit)
{
    const ale_motion_t *before = &prediction->before;
    const ale_motion_t *predicted = &ways->believed;
    p->map_uncertainty =
        ale_map_uncertainty_here(&p->map, p->still.observation, p->still.count, fit, &p->map_uncertainty);
    if (ways->counted) {
        ale_scale_error_predict(&p->scale_error, before->pose, predicted->pose,
                                ale_wheel_scale_error_ppm(&p->wheel_errors.scale));
    }
    ale_scale_error_update(&p->scale_error, observability, predicted);
    if (observability->determined) {
        p->drifted_um = 0;
    } else {
        ale_map_uncertainty_drift(&p->map_uncertainty, &p->drifted_um, observability->along_bam, before,
                                  predicted);
    }
}

/* The lag of the wheels from turns, their scale from displacements. */
static void learn_wheels(ale_pipeline_t *p, const ale_prediction_t *prediction, bool counted,
                         const ale_scale_error_t *before, const ale_motion_t *found)
{
    const ale_pose_t displacement = ale_pose_between(prediction->before.pose, found->pose);
    const ale_heading_t heading = {found->stamp_us, found->pose.theta_bam, found->velocity[2]};
    ale_lag_add_heading(&p->lag, &heading);
    ale_lag_update(&p->lag, &p->wheels);
    if (counted && prediction->wheels.lag_var_um2 < LEARN_LAG_VAR_UM2) {
        const ale_scale_error_t erred = {p->scale_error.x_um - before->x_um,
                                         p->scale_error.y_um - before->y_um};
        const ale_direction_t ahead = ale_direction(found->pose.theta_bam);
        const ale_wheel_lesson_t lesson = {prediction->before.stamp_us, found->stamp_us, displacement.x_um,
                                           prediction->wheels.counted_um,
                                           ale_scale_error_along(&erred, ahead.cos_q30, ahead.sin_q30)};
        ale_wheel_scale_learn(&p->wheel_errors.scale, &lesson);
    }
}

void ale_update_learn(ale_pipeline_t *p, const ale_prediction_t *prediction, const ale_ways_t *ways,
                      const ale_scale_error_t *before, const ale_fit_t *fit)
{
    const int64_t dt_us = fit->motion.stamp_us - prediction->before.stamp_us;
    ale_process_noise_learn(&p->process_noise[ways->counted], &ways->believed, &fit->motion);
    if (p->config.use_odometry && dt_us > 0 && dt_us <= ALE_SCAN_PERIOD_MAX_US &&
        ale_information_determines(&fit->information, LEARN_DETERMINED_UM)) {
        if (prediction->counted) {
            ale_wheel_monitor_compare(&p->wheel_monitor, prediction->wheels.displacement,
                                      ale_pose_between(prediction->before.pose, fit->motion.pose));
        }
        learn_wheels(p, prediction, ways->counted, before, &fit->motion);
    }
}

void ale_update_reanchor(ale_pipeline_t *p, ale_fit_t *fit)
{
    if (ale_tracking_may_reanchor(&p->monitor, fit)) {
        p->map_uncertainty = ale_map_uncertainty_inherit(&p->map_uncertainty, &fit->motion);
        ale_motion_widen(&fit->motion, REANCHOR_SIGMA_UM, REANCHOR_SIGMA_URAD);
    }
}

uint16_t ale_update_map(ale_pipeline_t *p, const ale_fit_t *fit, bool grow)
{
    if (p->frozen && p->atlas.current == ALE_FIRST_MAP) {
        return p->matched_corners;
    }
    const ale_pose_t sensor = ale_pose_compose(fit->motion.pose, p->config.sensor);
    const ale_map_update_context_t context = {p->scans, &p->map_uncertainty, &p->scale_error,
                                              ale_zero_motion_dilution(&p->zero_motion), grow};
    ale_map_update(&p->map, p->still.observation, p->still.count, fit, &context);
    return ale_map_corners_update(&p->map.corners, &p->observed.features, sensor, p->scans, grow);
}

ale_visibility_counts_t ale_update_decay(ale_pipeline_t *p, ale_pose_t robot)
{
    const ale_posed_scan_t from = {&p->still.scan, ale_observed_bearings(&p->observed),
                                   ale_pose_compose(robot, p->config.sensor)};
    ale_pipeline_approach(p, robot, p->still.scan.range_max_um);
    return ale_map_decay(&p->decay, &p->map, &from, p->scans,
                         p->monitor.state == ALE_STATE_GOOD && !p->frozen);
}

void ale_update_restart(ale_pipeline_t *p)
{
    p->scale_error = (ale_scale_error_t){0, 0};
    p->map_uncertainty = (ale_map_uncertainty_t){0};
    p->drifted_um = 0;
    p->decay.next = 0;
}
