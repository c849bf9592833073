#include "track/step_predict.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    SCAN_SET_BACK_US = 1000000, /* a stamp older than the last by less is a wrong stamp */
    STANDS_UM = 3000,           /* way and turn, as which scans see a robot that stands */
    GAP_PERIODS = 3
};

bool ale_pipeline_is_gap(const ale_pipeline_t *p, int64_t without_us)
{
    return without_us > GAP_PERIODS * p->timestamp_filter.usual_us &&
           without_us > ale_timestamp_filter_usual_most_us(&p->timestamp_filter);
}

void ale_pipeline_predict_motion(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                 const ale_wheel_motion_t *wheels)
{
    const ale_process_noise_t *noise = &p->process_noise[wheels != NULL];
    if (ale_timestamp_filter_accepts(&p->timestamp_filter, stamp_us - motion->stamp_us)) {
        ale_motion_predict(motion, stamp_us, wheels, noise);
    } else {
        ale_motion_jump(motion, stamp_us, wheels, noise);
    }
}

/* Wheels that have told of no motion, although scans have moved the robot from where it began, say nothing.
 */
static bool are_believed(const ale_pipeline_t *p)
{
    const ale_pose_t pose = p->motion.pose;
    return p->wheels.moved || ale_abs64(pose.x_um) + ale_abs64(pose.y_um) +
                                      ale_abs64(ale_bam_to_nrad((int32_t)pose.theta_bam)) / 1000 <
                                  STANDS_UM;
}

/* By wheels that are believed, else by its velocity alone. `known`: they tell of that time. */
static bool predict(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                    ale_wheel_motion_t *wheels, bool *known)
{
    *known = ale_wheel_motion(&p->wheels, &p->lag, &p->wheel_errors, motion->stamp_us, stamp_us, wheels);
    const bool believed = *known && are_believed(p);
    ale_pipeline_predict_motion(p, motion, stamp_us, believed ? wheels : NULL);
    return believed;
}

bool ale_pipeline_predict_by_wheels(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                    ale_wheel_motion_t *wheels)
{
    bool known;
    return predict(p, motion, stamp_us, wheels, &known);
}

/* Scans come in their order, whatever their stamps say of it. A clock that was set back is followed. */
static int64_t in_order(const ale_pipeline_t *p, int64_t instant_us)
{
    const int64_t last_us = p->motion.stamp_us;
    const bool late = p->started && instant_us <= last_us && instant_us > last_us - SCAN_SET_BACK_US;
    return late ? last_us + 1 : instant_us;
}

void ale_pipeline_take_odometry(ale_pipeline_t *p)
{
    if (p->is_pending) {
        if (p->started) { /* the next prediction begins there, however long it takes */
            const bool waits = p->waits > 0;
            const int64_t from_us = waits ? p->watched.stamp_us : p->motion.stamp_us;
            ale_wheels_keep(&p->wheels, from_us - p->lag.lag_us);
        }
        ale_wheels_add(&p->wheels, &p->pending);
        p->is_pending = false;
    }
}

int64_t ale_pipeline_instant(ale_pipeline_t *p, int64_t stamp_us)
{
    const int64_t instant_us = in_order(p, ale_timestamp_filter_instant(&p->timestamp_filter, stamp_us));
    if (p->pending.stamp_us == stamp_us) {
        p->pending.stamp_us = instant_us;
    }
    ale_pipeline_take_odometry(p);
    return instant_us;
}

/* The wheels and constant velocity; as long as the wheels slip, or contradict the scans, constant velocity is
 * selected. */
static ale_ways_t hypotheses(const ale_pipeline_t *p, const ale_motion_t *by_wheels)
{
    ale_motion_t constant_velocity = p->motion;
    ale_pipeline_predict_motion(p, &constant_velocity, by_wheels->stamp_us, NULL);
    const bool lie = p->slips || p->wheel_monitor.fault != ALE_WHEELS_FINE;
    return ale_ways_of(by_wheels, &constant_velocity, lie && p->monitor.state != ALE_STATE_LOST);
}

/* Over all of a time unwatched at once: from scan to scan that were waited from, wheels that are told late
 * were wrong at each of them. */
static ale_motion_t since_watched(const ale_pipeline_t *p, const ale_motion_t *predicted)
{
    ale_motion_t motion = p->watched;
    ale_wheel_motion_t wheels;
    const bool counted = ale_pipeline_predict_by_wheels(p, &motion, predicted->stamp_us, &wheels);
    return counted ? motion : *predicted;
}

ale_prediction_t ale_step_predict(ale_pipeline_t *p, int64_t stamp_us)
{
    ale_prediction_t prediction = {.before = p->motion};
    const int64_t instant_us = ale_pipeline_instant(p, stamp_us);
    const int64_t dt_us = instant_us - p->motion.stamp_us;
    ale_motion_t predicted = p->motion;
    const bool believed = predict(p, &predicted, instant_us, &prediction.wheels, &prediction.counted);
    prediction.next = predicted.pose;
    const bool waits = p->waits > 0;
    if (waits && believed) {
        predicted = since_watched(p, &predicted);
    }
    prediction.ways =
        believed ? hypotheses(p, &predicted) : (ale_ways_t){.believed = predicted, .rival = predicted};
    prediction.dt_us =
        ale_timestamp_filter_accepts(&p->timestamp_filter, dt_us) ? dt_us : p->timestamp_filter.usual_us;
    return prediction;
}
