/* Poses and points of the plane: x forward, y left, heading counter-clockwise.
 *
 * A pose maps a point of its own frame to the frame it is given in:  p' = R(theta) p + (x, y), with
 * R = [cos -sin; sin cos] (the paper's (29) prints the transpose). Micrometres and BAM.
 *
 * Pure functions of constant time, no error. Results must stay within +-2147 m of the origin along each axis,
 * which is not checked, but by ale_pose_between. */
#ifndef ALE_BASE_POSE_H
#define ALE_BASE_POSE_H

#include <stdint.h>

#include "base/fixed.h"
#include "base/trig.h"

typedef struct {
    int32_t x_um;
    int32_t y_um;
} ale_point_t;

typedef struct {
    int32_t x_um;
    int32_t y_um;
    uint32_t theta_bam;
} ale_pose_t;

/* The point turned about the origin, rounded to the micrometre. */
ale_point_t ale_rotate(ale_point_t p, uint32_t angle_bam);

/* The same for many points: by the angle whose cosine and sine are given. */
static inline ale_point_t ale_turn(ale_point_t p, ale_direction_t direction)
{
    const int64_t c = direction.cos_q30;
    const int64_t s = direction.sin_q30;
    return (ale_point_t){(int32_t)ale_round_shift(c * p.x_um - s * p.y_um, 30),
                         (int32_t)ale_round_shift(s * p.x_um + c * p.y_um, 30)};
}

/* The point p of the pose's frame, in the frame the pose is given in. */
ale_point_t ale_pose_apply(ale_pose_t pose, ale_point_t p);

/* The pose b, given in the frame of a, in the frame a is given in. */
ale_pose_t ale_pose_compose(ale_pose_t a, ale_pose_t b);

/* The pose b as seen from a (both given in one frame): compose(a, between(a, b)) is b. Poses farther apart
 * than 2147 m along an axis, as a broken odometry may name them, are as far apart as can be told. */
ale_pose_t ale_pose_between(ale_pose_t a, ale_pose_t b);

/* The motion of the whole plane that carries the pose `from` to the pose `to`: compose(shift, from) is `to`
 * to the micrometre, and from a pose to itself it is no motion at all. */
ale_pose_t ale_pose_shift(ale_pose_t from, ale_pose_t to);

#endif
