/* Wheel odometry: a buffer of stamped poses that is asked for the pose at any instant.
 *
 * Samples come when they come, late or out of step with the scans. Between two samples the pose is
 * interpolated; beyond the newest it is extrapolated by ALE_WHEELS_EXTRAPOLATE_US at most. A reset of
 * the counters or a jump that the robot could not have driven begins a new epoch: no motion is read
 * across it. One owner; every loop bounded by the buffer. */
#ifndef ALE_MOTION_ODOMETRY_H
#define ALE_MOTION_ODOMETRY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "motion/odometry_sample.h"

enum {
    ALE_WHEELS_SAMPLES = 128, /* 1.28 s of wheels at 100 Hz, 12 s at 10 Hz; longer where it is kept */
    ALE_WHEELS_BEFORE = 48,   /* of them at most before the instant that is kept */
    ALE_WHEELS_EXTRAPOLATE_US = 150000, /* longest look beyond the newest sample */
    ALE_WHEELS_GAP_US = 600000000       /* samples farther apart begin anew */
};

typedef struct {
    ale_odometry_t sample[ALE_WHEELS_SAMPLES]; /* ring; oldest at first, stamps ascending */
    uint32_t first;
    uint32_t count;
    uint32_t jumps;  /* epochs begun by a reset or a jump */
    int64_t kept_us; /* motion from here on may be asked for however long it takes */
    bool moved;      /* ever: what has always told one pose may be left unconnected */
    int32_t max_speed_mm_s;
    int32_t max_turn_mrad_s;
} ale_wheels_t;

void ale_wheels_init(ale_wheels_t *wheels, int32_t max_speed_mm_s, int32_t max_turn_mrad_s);

/* Takes a sample. One that is not newer than the newest is ignored when it lies on the way that is known;
 * when the wheels have gone on since, its stamp is wrong, and it counts as just taken. One that is older by
 * more than a second (a clock set back) or a jump begins the buffer anew with this sample. A pause of minutes
 * is no jump: what wheels have counted stays true, and many are silent while the robot rests. */
void ale_wheels_add(ale_wheels_t *wheels, const ale_odometry_t *sample);

/* Motion will be asked for from this instant on, until another one is named: while the buffer is full,
 * samples in the middle make room for new ones, and both ends of the way stay as they were told. Before the
 * first call the oldest ones make room. */
void ale_wheels_keep(ale_wheels_t *wheels, int64_t from_us);

/* Pose of the wheels at an instant of the samples' clock. False when the buffer does not reach there.
 * *beyond_us: how far the newest sample was extrapolated, 0 inside. */
bool ale_wheels_at(const ale_wheels_t *wheels, int64_t t_us, ale_pose_t *out, int32_t *beyond_us);

/* Motion from one instant to a later one, in the frame of the earlier. False as above. */
bool ale_wheels_motion(const ale_wheels_t *wheels, int64_t from_us, int64_t to_us, ale_pose_t *out,
                       int32_t *beyond_us);

/* Way and turns that the samples between two instants tell of, however they cancel, um and urad; 0 where
 * there is none between. Of a way whose middle was thinned it is the least. */
int64_t ale_wheels_way_um(const ale_wheels_t *wheels, int64_t from_us, int64_t to_us, int64_t *turned_urad);

/* Time between the two samples around an instant, or between the last two. 0 when there are none. */
int64_t ale_wheels_gap_us(const ale_wheels_t *wheels, int64_t t_us);

/* The oldest sample not older than an instant, or NULL. Valid until the next sample is added. */
const ale_odometry_t *ale_wheels_sample_from(const ale_wheels_t *wheels, int64_t t_us);

#endif
