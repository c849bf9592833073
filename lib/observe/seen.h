/* What a scan showed and where it was taken from, as later scans are compared with it; and a copy that
 * outlives the scan. */
#ifndef ALE_OBSERVE_SEEN_H
#define ALE_OBSERVE_SEEN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "observe/observation.h"

/* A straightened scan, where it was taken from, and what it shows. bearing_bam NULL: regular. */
typedef struct {
    const ale_scan_t *scan;
    const uint32_t *bearing_bam;
    ale_pose_t robot; /* in any frame that both scans are given in */
    ale_pose_t sensor;
    const ale_observation_t *observation; /* robot's frame */
    uint32_t observation_count;           /* ALE_MAX_OBSERVATIONS at most */
} ale_seen_t;

/* The same without the observations, copied. */
typedef struct {
    ale_scan_t scan;
    uint32_t bearing_bam[ALE_MAX_BEAMS];
    ale_pose_t robot;
    ale_pose_t sensor;
    bool straightened; /* bearing_bam holds */
} ale_seen_copy_t;

/* O(beams). */
void ale_seen_copy(ale_seen_copy_t *copy, const ale_seen_t *seen);

/* Bearings of the copied scan, NULL when they are regular. */
const uint32_t *ale_seen_bearings(const ale_seen_copy_t *copy);

/* Whether two poses differ by less along x, along y and in the heading. */
bool ale_are_near(ale_pose_t a, ale_pose_t b, int32_t within_um, int32_t within_bam);

#endif
