/* A few earlier scans from where the robot stands: was what is seen now always there, or has it come since?
 *
 * People stop and their legs make a short line, which is a wall as far as one scan can tell. Where one of the
 * elders, taken from the same place, looked through the place, something has come to stand there: it begins
 * no wall while the robot stays. Once the robot has gone on, what still stands is mapped as all else. The
 * elders' ages are 5, 10, 20 .. 640 s, at most twice that: who stops for minutes does not become a wall, and
 * who stood there when the robot came is known by those that were taken while he was away. */
#ifndef ALE_TRACK_EVIDENCE_ELDERS_H
#define ALE_TRACK_EVIDENCE_ELDERS_H

#include <stdbool.h>
#include <stdint.h>

#include "match/association.h"
#include "observe/seen.h"

enum { ALE_ELDERS = 8 };

typedef struct {
    bool taken;
    ale_seen_copy_t seen; /* on the way that is smooth */
} ale_elder_t;

typedef struct {
    ale_elder_t elder[ALE_ELDERS];
    uint32_t kept;
    int64_t kept_us; /* stamp of the last one */
} ale_elders_t;

void ale_elders_clear(ale_elders_t *elders);

/* Copies the scan when 5 s have passed since the last one; false: it is not kept. Only scans whose pose is
 * known. */
bool ale_elders_keep(ale_elders_t *elders, const ale_seen_t *seen);

/* Takes the lines that found no wall of the map and were not always there out of the observations, and their
 * matches with them; seen->view is `view`. rests: the robot has stood still for long enough to tell more
 * exactly; those that found a young wall, or would lengthen theirs, are asked for, too. Returns how many
 * observations are left. At most 8 lines are asked for, the rest are left as they are: O(8 * ALE_ELDERS). */
uint32_t ale_elders_drop_newcomers(const ale_elders_t *elders, const ale_local_map_t *map,
                                   const ale_seen_t *seen, bool rests, ale_observation_t observation[],
                                   ale_association_t association[]);

#endif
