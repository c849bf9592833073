/* A scan, the bearings of its beams, and the pose of the sensor that took it: what a question about a place
 * asks. */
#ifndef ALE_OBSERVE_POSED_SCAN_H
#define ALE_OBSERVE_POSED_SCAN_H

#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"

/* Borrowed: both arrays must outlive it. */
typedef struct {
    const ale_scan_t *scan;
    const uint32_t *bearing_bam; /* of every beam of a deskewed scan, sensor frame; NULL: the scan's */
    ale_pose_t sensor;           /* in the frame that whoever takes it names */
} ale_posed_scan_t;

/* Bearing of one of its beams, in the sensor's frame. */
static inline uint32_t ale_posed_bearing(const ale_posed_scan_t *from, int32_t beam)
{
    return from->bearing_bam ? from->bearing_bam[beam] : ale_scan_bearing(from->scan, beam);
}

#endif
