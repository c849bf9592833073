/* The speed with which the robot may go on so that it can stop before what the scanner sees.
 *
 *     path along the arc until the disc touches a point  >=  v t + v^2 / (2 a)    (t reaction, a
 * deceleration)
 *
 *   v = ale_safe_speed_um_s(&scan, &sensor, &shape, wanted_v, wanted_w);
 *   w = wanted_w * v / wanted_v;                               (the same arc, slower)
 *
 * Pure functions, no error; thread-safe. */
#ifndef ALE_PLAN_SAFE_SPEED_H
#define ALE_PLAN_SAFE_SPEED_H

#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"
#include "plan/robot_shape.h"

/* Path of the robot's centre, along the arc, until its disc of `radius_um` touches the point p (robot's
 * frame, as all here); INT64_MAX when it never does. A point inside the disc blocks the path towards it (0)
 * and not the one away from it. The arc is that of speed_um_s (not 0; its sign is the direction) and
 * turn_urad_s; flatter than 1 km of radius counts as straight. |p| up to 100 m, radius up to 10 m. Constant
 * time. */
int64_t ale_distance_to_contact_um(ale_point_t p, int32_t radius_um, int32_t speed_um_s, int32_t turn_urad_s);

/* Largest v with v t + v^2 / (2 a) <= distance, um/s, 0..INT32_MAX. distance_um >= 0. Constant time. */
int32_t ale_stopping_speed_um_s(int64_t distance_um, const ale_robot_shape_t *shape);

/* wanted_um_s, cut down in size, never in sign, so that the robot can stop `margin_um` before every range of
 * the scan that lies on its arc. Valid beams, outliers and beams that are too near count (those at the least
 * range). Where fewer than half of the beams within 30 degrees of the direction of travel say anything, or
 * the scanner does not look there, at most `blind_um_s`. A wanted speed of 0 (turning in place) stays 0. The
 * scan is taken as measured at one instant; its sweep and age belong into `reaction_us`. sensor: the scanner
 * in the robot's frame. O(beams), two roots and two arc tangents a beam. */
int32_t ale_safe_speed_um_s(const ale_scan_t *scan, const ale_pose_t *sensor, const ale_robot_shape_t *shape,
                            int32_t wanted_um_s, int32_t wanted_urad_s);

#endif
