/* Lost: places where the robot could be are kept, followed and compared until only one is left.
 *
 * One scan at a time is looked for in the whole map, over as many scans as that takes (a round,
 * hypothesis.h); what is proposed, and is explained by what was seen on the way so far (trail.h), joins the
 * places that are kept. All of them move as the robot does; a few are fitted to the newest scan in turn, and
 * each remembers how much of what scans showed lay on walls there. A place is the answer when it has held for
 * a while, explains nearly all, and no other place explains nearly as much, nor a place half a metre before
 * or behind it: in a building of equal rooms that takes a drive into the next one, in a corridor one to its
 * end. Only rounds tell that there is no other: those that proposed every place that could explain nearly as
 * much, because the pair of walls that was looked for is a good part of what was seen, and room was left for
 * all of them. A corridor whose only corners are those of door frames tells nothing. Without wheels nobody
 * knows the way, and a round goes on with each new scan. Work a scan is bounded by ALE_PLACES_FITTED fits,
 * fewer of a rich scan, and one turn of the search; a scan that is asked for the answer does neither. One
 * owner. */
#ifndef ALE_RELOCATE_RELOCATION_H
#define ALE_RELOCATE_RELOCATION_H

#include <stdbool.h>
#include <stdint.h>

#include "map/visibility.h"
#include "match/scan_to_map.h"
#include "relocate/hypothesis.h"
#include "relocate/trail.h"

enum { ALE_PLACES = 32, ALE_PLACES_FITTED = 4 };

typedef struct {
    ale_pose_t pose;
    int32_t score_q8; /* part explained of what scans showed and of the walls in view: mean */
    int32_t
        coverage_q8; /* what rounds have told of its rivals: the sum of the pairs' parts of what was seen */
    uint16_t scans;  /* fitted to so many */
} ale_place_t;

typedef struct {
    ale_search_t search;
    ale_trail_t trail; /* the newest of it is what is looked for */
    bool searching;    /* a round is under way, */
    bool crowded;      /* in which there was no room for a place */
    int32_t pair_q8;   /* its pair's part of what was seen */
    int64_t way_um;    /* driven since something told was forgotten */
    ale_place_t place[ALE_PLACES];
    uint16_t count;
    uint16_t next;      /* to be fitted */
    uint16_t next_wall; /* to be asked whether it is seen through */
} ale_relocation_t;

/* A straightened scan, and the mounting of what took it. bearing_bam as for ale_extract_scan. */
typedef struct {
    const ale_scan_t *scan;
    const uint32_t *bearing_bam;
    ale_pose_t sensor;
} ale_mounted_scan_t;

/* Lost anew. */
void ale_relocation_clear(ale_relocation_t *relocation);

/* The robot has gone a way in its own frame, and with it every place that is kept. counted: wheels told. */
void ale_relocation_follow(ale_relocation_t *relocation, ale_pose_t way, bool counted);

/* One scan more. `predicted`: the motion, of which only the velocity is believed; `fit`: working memory. The
 * near list of the map must hold all walls. True: fit->motion is where the robot is. */
bool ale_relocate(ale_relocation_t *relocation, const ale_scene_t *scene, const ale_mounted_scan_t *mounted,
                  const ale_motion_t *predicted, ale_fit_t *fit);

#endif
