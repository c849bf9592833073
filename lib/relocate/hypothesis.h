/* Where could the robot be? The paper's section IV: adopt one corner in the scan and one in the map, rotate
 * for overlap, and if the result does not satisfy check the next; of two similar ones take the better.
 *
 * A corner is two walls that meet at an angle: two observations of the scan and two walls of the map that
 * enclose the same angle give a pose, which is scored by the length of the scan's lines that then lie on
 * walls. The pairs of the map are gone through a bounded number at a time, call after call, as long as it
 * takes: a round that is made with one scan proposes every place at which the pair of views lies on walls.
 * Every other round takes another pair, for where one of its walls is in short segments in the map. */
#ifndef ALE_RELOCATE_HYPOTHESIS_H
#define ALE_RELOCATE_HYPOTHESIS_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "match/association.h"
#include "observe/observation.h"

enum {
    ALE_MAX_HYPOTHESES = 24,    /* scored in one scan, */
    ALE_SEARCH_WORK = 12288,    /* or fewer: walls that scoring may look at */
    ALE_HYPOTHESIS_POSES = 256, /* computed in one scan */
    ALE_HYPOTHESIS_PAIRS = 4096 /* pairs of walls looked at in one scan */
};

typedef struct {
    uint16_t first; /* pair of walls to go on at */
    uint16_t second;
    uint32_t rounds; /* times all pairs were gone through */
} ale_search_t;

typedef struct {
    int64_t score_um; /* length of the scan's lines that lie on walls */
    int64_t shown_um; /* length of all lines */
    ale_pose_t pose;
    uint16_t observations; /* lines that lie on walls */
} ale_hypothesis_t;

/* The pose that puts two observations on two walls, least squares in the angle. False when the walls enclose
 * too small an angle. */
bool ale_pose_of_pair(const ale_observation_t *a, const ale_observation_t *b, const ale_wall_t *wall_a,
                      const ale_wall_t *wall_b, ale_pose_t *out);

/* How well a pose explains the lines of a scan, among the walls that the map is focused on, as far as
 * *work suffices (as for ale_associate). */
ale_hypothesis_t ale_hypothesis_at(const ale_local_map_t *map, const ale_observation_t observation[],
                                   uint32_t count, ale_pose_t pose, const ale_gate_t *gate, int32_t *work);

/* Part of what the scan shows that each of the two observations has which this round looks for, 256: all. A
 * place that is not proposed does not explain as much. 0: no pair. */
int32_t ale_search_pair_q8(const ale_search_t *search, const ale_observation_t observation[], uint32_t count);

/* Goes on with the search for the observations of this scan, up to the end of the round at most; returns how
 * many hypotheses it made. The near list of the map must hold all walls; it is focused on all of them. */
uint32_t ale_search(ale_search_t *search, ale_local_map_t *map, const ale_observation_t observation[],
                    uint32_t count, ale_hypothesis_t out[ALE_MAX_HYPOTHESES]);

#endif
