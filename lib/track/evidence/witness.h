/* The last scan that fitted, as witness of the next: was what is seen now there before, and is what was
 * there before still seen?
 *
 * A map says nothing of places it does not hold: a robot that turns in a room it has not seen all of shows
 * little of the map and is right all the same. Two scans taken one after the other from poses that are known
 * must agree where both look: a surface of one lies where the other saw it, or out of its view, or hidden,
 * but not where it saw through. A scene that has changed all at once does not pass: the robot was
 * carried away, tilted, or its pose is wrong. At most 32 surfaces of either scan are asked, three points
 * each. */
#ifndef ALE_TRACK_EVIDENCE_WITNESS_H
#define ALE_TRACK_EVIDENCE_WITNESS_H

#include <stdbool.h>
#include <stdint.h>

#include "map/visibility.h"
#include "match/scan_to_map.h"
#include "observe/seen.h"

enum { ALE_WITNESS_SLACK_UM = 60000 }; /* how far surfaces of two scans may lie apart in any case */

typedef struct {
    ale_seen_copy_t seen;
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    uint32_t observation_count; /* 0: nobody saw anything */
} ale_witness_t;

/* Length of the surfaces of both scans, and of those that the other one confirms, and that it saw through. */
typedef struct {
    int64_t shown_um;
    int64_t confirmed_um;
    int64_t denied_um;
    bool close; /* taken so close to each other that each must confirm much of the other */
} ale_testimony_t;

void ale_witness_clear(ale_witness_t *witness);

/* Takes the place of the scan before; copies. */
void ale_witness_keep(ale_witness_t *witness, const ale_seen_t *seen);

/* The scan that is kept was taken from here. */
void ale_witness_stand(ale_witness_t *witness, ale_pose_t robot, ale_pose_t sensor);

/* The scan that is kept, as long as it is; its view_count is 0 when there is none. */
ale_seen_t ale_witness_seen(const ale_witness_t *witness);

/* slack: how far the way between the two scans may be off. */
ale_testimony_t ale_witness_hear(const ale_witness_t *witness, const ale_seen_t *seen, ale_slack_t slack);

#endif
