/* Pose hypotheses by exhaustive search of the map; paper, section IV: adopt a corner of the scan and one of
 * the map, rotate for overlap, check, and take the better of two that are alike.
 *
 * A corner is two walls at an angle. Two observations of the scan and two walls of the map that enclose the
 * same angle give a pose; its score is the length of the scan's lines that then lie on walls. The pairs of
 * walls are gone through in a bounded number per call. A round is one pass over all pairs: for one scan it
 * proposes every pose that lays the scan's pair on walls. Every other round takes another pair of the scan,
 * since a wall of the first may be mapped in pieces. */
#ifndef ALE_RELOCATE_HYPOTHESIS_H
#define ALE_RELOCATE_HYPOTHESIS_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "match/association.h"
#include "observe/observation.h"

enum {
    ALE_MAX_HYPOTHESES = 24,    /* scored in one call, */
    ALE_SEARCH_WORK = 12288,    /* as far as this work budget suffices, see ale_associate */
    ALE_HYPOTHESIS_POSES = 256, /* poses computed in one call */
    ALE_HYPOTHESIS_PAIRS = 4096 /* pairs of walls compared in one call */
};

typedef struct {
    uint16_t first; /* next pair of walls */
    uint16_t second;
    uint32_t rounds; /* completed */
} ale_search_t;

typedef struct {
    int64_t score_um; /* length of the scan's lines that lie on walls */
    int64_t shown_um; /* length of all its lines */
    ale_pose_t pose;
    uint16_t observations; /* lines that lie on walls */
} ale_hypothesis_t;

/* The pose that lays two observations on two walls, the heading being the mean of what either asks for.
 * False: the walls enclose less than 14 degrees (*out is untouched) or the pose is farther out than 2147 m.
 */
bool ale_pose_of_pair(const ale_observation_t *a, const ale_observation_t *b, const ale_wall_t *wall_a,
                      const ale_wall_t *wall_b, ale_pose_t *out);

/* Scores a pose by the lines of a scan, among the walls that the map is focused on, as far as *work suffices
 * (see ale_associate). O(count). */
ale_hypothesis_t ale_hypothesis_at(const ale_local_map_t *map, const ale_observation_t observation[],
                                   uint32_t count, ale_pose_t pose, const ale_gate_t *gate, int32_t *work);

/* Part of the scan's lines that the shorter observation of this round's pair is, 256: all; 0: no pair. A pose
 * that the round does not propose leaves at least that much unexplained. O(count^2). */
int32_t ale_search_pair_q8(const ale_search_t *search, const ale_observation_t observation[], uint32_t count);

/* Continues the search with the observations of a scan, to the end of the round at most; returns the number
 * of hypotheses. The near list of the map must hold all walls; on return the map is focused on all of them.
 */
uint32_t ale_search(ale_search_t *search, ale_local_map_t *map, const ale_observation_t observation[],
                    uint32_t count, ale_hypothesis_t out[ALE_MAX_HYPOTHESES]);

#endif
