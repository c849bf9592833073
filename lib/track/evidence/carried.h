/* What has come before the scanner and goes along with the robot: a hand, a sack, a box, the floor that a
 * tilted scanner meets.
 *
 * Mapped as if it stood in the room it says that the robot stands, and in the end it pulls the pose along.
 * Where a scan that fits shows a surface that the map does not hold, and the last scan looked through its
 * place, something has come. If it takes a good part of the beams all at once, they are left out as long as
 * they show about the same range, as they do while it goes along. Something that stands in the room comes to
 * another range as the robot moves; it is mapped 10 s after the robot moves on, at the most. Bounded:
 * O(beams), and three looks at the last scan for each view that was not matched. */
#ifndef ALE_TRACK_EVIDENCE_CARRIED_H
#define ALE_TRACK_EVIDENCE_CARRIED_H

#include <stdbool.h>
#include <stdint.h>

#include "map/visibility.h"
#include "match/association.h"
#include "observe/seen.h"

typedef struct {
    int32_t came_um[ALE_MAX_BEAMS]; /* the range of each beam that met it when it came; 0: none; negative:
                                       what the beam shows since this scan is elsewhere */
    int32_t last_um[ALE_MAX_BEAMS]; /* and in the last scan */
    int64_t came_us;                /* stamp of the scan in which a good part of it came */
    uint16_t beams;
    bool any;
} ale_carried_t;

void ale_carried_clear(ale_carried_t *carried);

/* Makes blind the beams that still meet it, and forgets the others. */
void ale_carried_mask(ale_carried_t *carried, ale_scan_t *scan);

/* Gives those beams their ranges back: the space up to it is free. */
void ale_carried_show(const ale_carried_t *carried, ale_scan_t *scan);

/* Takes what has come since an earlier scan out of a fitted one: its observations with their matches, and its
 * beams, which become blind. now->view is `view`, now->scan is `scan`; the way between the two scans is known
 * to centimetres. Returns how many observations are left. */
uint32_t ale_carried_notice(ale_carried_t *carried, const ale_seen_t *before, const ale_seen_t *now,
                            ale_scan_t *scan, ale_observation_t observation[],
                            ale_association_t association[]);

#endif
