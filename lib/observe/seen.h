/* A scan record: a posed scan with its observations, to compare later scans with; and a copy that outlives
 * it. */
#ifndef ALE_OBSERVE_SEEN_H
#define ALE_OBSERVE_SEEN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "observe/observation.h"
#include "observe/posed_scan.h"

/* A deskewed scan, where it was taken from, and what it shows. */
typedef struct {
    ale_posed_scan_t posed;               /* in any frame that both scans are given in */
    ale_pose_t robot;                     /* in the same frame */
    const ale_observation_t *observation; /* robot's frame */
    uint32_t observation_count;           /* ALE_MAX_OBSERVATIONS at most */
} ale_seen_t;

/* A copy without the observations. */
typedef struct {
    ale_scan_t scan;
    uint32_t bearing_bam[ALE_MAX_BEAMS];
    ale_pose_t robot;
    ale_pose_t sensor;
    bool straightened; /* bearing_bam holds */
} ale_seen_copy_t;

/* O(beams). */
void ale_seen_copy(ale_seen_copy_t *copy, const ale_seen_t *seen);

/* The copied scan, borrowed from the copy. */
ale_posed_scan_t ale_seen_copy_posed(const ale_seen_copy_t *copy);

/* Whether two poses differ by less along x, along y and in the heading. */
bool ale_are_near(ale_pose_t a, ale_pose_t b, int32_t within_um, int32_t within_bam);

#endif
