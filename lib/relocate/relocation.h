/* Global relocalisation: candidate places are kept, tracked and scored until only one is left.
 *
 * One scan at a time is the query: a round (hypothesis.h) searches the whole map for it, over as many scans
 * as that takes. A proposal that the scan history (trail.h) supports joins the places that are kept. All
 * places move with the odometry; a few per scan are fitted to it in turn, and each keeps a score: the part of
 * what scans showed that lay on walls there, less the walls in view that scans saw through. The answer is a
 * place whose score has been high for a while, well above that of every other place and of the places half a
 * metre before and behind it. It needs search coverage too: rounds whose pair is a good part of the query,
 * with room for every proposal, have shown that no place as good was missed. In a building of equal rooms
 * that takes a drive into the next one, in a corridor one to its end. Without odometry no place can be moved,
 * and a round continues with each new scan. Work per scan: at most ALE_PLACES_FITTED fits, fewer of a rich
 * scan, and one turn of the search; a scan that confirms the answer does neither. One owner. */
#ifndef ALE_RELOCATE_RELOCATION_H
#define ALE_RELOCATE_RELOCATION_H

#include <stdbool.h>
#include <stdint.h>

#include "match/scan_to_map.h"
#include "observe/posed_scan.h"
#include "relocate/hypothesis.h"
#include "relocate/trail.h"

enum { ALE_PLACES = 32, ALE_PLACES_FITTED = 4 };

typedef struct {
    ale_pose_t pose;
    int32_t score_q8;    /* part explained, 256: all; smoothed over the fits */
    int32_t coverage_q8; /* of the search for rivals: sum of the rounds' pair_q8, expiring with the path */
    uint16_t scans;      /* fits so far */
} ale_place_t;

typedef struct {
    ale_search_t search;
    ale_trail_t trail; /* its newest scan is the query */
    bool searching;    /* a round is under way, */
    bool crowded;      /* and a good place found no room in it */
    int32_t pair_q8;   /* part of the query that the round's pair is, 256: all */
    int64_t path_um;   /* driven since coverage last expired by a step */
    ale_place_t place[ALE_PLACES];
    uint16_t count;
    uint16_t next;      /* place to be fitted */
    uint16_t next_wall; /* to be asked whether it is visible */
    bool recognised;    /* by the last scan, */
    ale_pose_t at;      /* there, seen from where the robot is now */
} ale_relocation_t;

/* Begins a new search. */
void ale_relocation_clear(ale_relocation_t *relocation);

/* The robot has recognised a place; the next scan is to confirm it. */
void ale_relocation_recognise(ale_relocation_t *relocation, ale_pose_t at);

/* Where the scan at hand is to confirm that the robot is; false: the last one has recognised nothing. Asked
 * once. */
bool ale_relocation_recognised(ale_relocation_t *relocation, ale_pose_t *at);

/* Moves every place by the robot's displacement, in its own frame. counted: the displacement is odometry;
 * without it the scan history is dropped. O(ALE_PLACES). */
void ale_relocation_follow(ale_relocation_t *relocation, ale_pose_t displacement, bool counted);

/* Processes one scan. mounted: the scan with the sensor's pose in the robot's frame. predicted: only its
 * velocity is used. fit: working memory. The near list of the map must hold all walls; the scene has 1
 * observation or more. True: fit->motion is the answer, associated and weighed. */
bool ale_relocate(ale_relocation_t *relocation, const ale_scene_t *scene, const ale_posed_scan_t *mounted,
                  const ale_motion_t *predicted, ale_fit_t *fit);

#endif
