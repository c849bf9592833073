/* Deskewing: each beam as it would have been measured from where the sensor was at the stamp.
 *
 * While a scanner turns, the robot moves: at 2 rad/s the ends of a URG's scan are bent by 4 degrees.
 * With the motion known as a velocity, the beam taken at time t after the stamp is moved by it; out come
 * range and bearing of each beam in the sensor's frame at the stamp. The moved bearings stay in the
 * order of the beams as long as the robot turns slower than the mirror. O(beams), constant work a beam.
 * Twin: tests/lib/motion/test_deskew.cpp, within 3 um and 2 urad. */
#ifndef ALE_MOTION_DESKEW_H
#define ALE_MOTION_DESKEW_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"
#include "motion/motion.h"

/* Velocity of the sensor in its own frame, mounted at `sensor` on a robot of the given velocity. */
void ale_sensor_velocity(const int32_t robot_velocity[ALE_AXES], ale_pose_t sensor, int32_t out[ALE_AXES]);

/* Moves the ranges of the scan in place and writes a bearing for every beam, also for those without a
 * range. Returns false, with nothing written, when the scan is whole (beam_time 0) or the sensor rests:
 * then the regular bearings hold. */
bool ale_deskew(ale_scan_t *scan, const int32_t sensor_velocity[ALE_AXES], uint32_t bearing_bam[]);

#endif
