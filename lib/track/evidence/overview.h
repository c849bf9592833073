/* The last scan that showed much: which of those before tells best where the next one was taken.
 *
 * A scanner that is covered for a moment, or comes close to something, shows next to nothing, and the last
 * such scan says little of the first good one after it. The better one before is kept for two seconds, as
 * long as the robot has not gone half a metre or turned half a radian. One owner. */
#ifndef ALE_TRACK_EVIDENCE_OVERVIEW_H
#define ALE_TRACK_EVIDENCE_OVERVIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "observe/observation.h"
#include "observe/seen.h"

typedef struct {
    ale_observation_t observation[ALE_MAX_OBSERVATIONS]; /* robot's frame */
    uint32_t observation_count;                          /* 0: nobody saw anything */
    int64_t shown_um;                                    /* their length */
    int64_t stamp_us;
    ale_pose_t robot;
} ale_overview_t;

void ale_overview_clear(ale_overview_t *overview);

/* A scan that fitted: it takes the place of the one that is kept unless it shows less than half as much.
 * Copies; O(observations). */
void ale_overview_keep(ale_overview_t *overview, const ale_seen_t *seen, int64_t stamp_us);

/* The scan of this stamp was taken from here, if it is the one that is kept. */
void ale_overview_stand(ale_overview_t *overview, int64_t stamp_us, ale_pose_t robot);

/* Whether it shows more than twice as much as these observations. O(observations). */
bool ale_overview_is_richer(const ale_overview_t *overview, const ale_observation_t observation[],
                            uint32_t count);

#endif
