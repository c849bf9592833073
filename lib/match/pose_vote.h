/* Where in a region a scan can have been taken: all headings and places of it are compared on a likelihood
 * grid, first coarsely, then those that explain most finely. Correlative scan matching (Olson, ICRA 2009) in
 * integers and bounded time: needs neither lines nor a guess, and says how well other places explain the
 * scan.
 *
 * Work: ALE_VOTE_HEADINGS times ALE_VOTE_POINTS times ALE_VOTE_CELLS cells, eight at a time; and a quarter of
 * that for each of nine headings at ALE_VOTE_PLACES places. */
#ifndef ALE_MATCH_POSE_VOTE_H
#define ALE_MATCH_POSE_VOTE_H

#include <stdint.h>

#include "match/likelihood_grid.h"
#include "observe/observation.h"

enum {
    ALE_VOTE_POINTS = 96,
    ALE_VOTE_SIDE = 16, /* coarse cells a side of the region: 6.4 m */
    ALE_VOTE_CELLS = ALE_VOTE_SIDE * ALE_VOTE_SIDE,
    ALE_VOTE_HEADINGS = 96, /* of a full turn */
    ALE_VOTE_PLACES = 8,    /* that are looked at finely */
    ALE_VOTE_REACH_UM = ALE_VOTE_SIDE / 2 * ALE_GRID_POOL * ALE_GRID_CELL_UM
};

/* A pose and what of the scan it explains. */
typedef struct {
    ale_pose_t pose;
    int32_t score_q8; /* part of the points that lie on surfaces, 256: all */
} ale_voted_pose_t;

/* What a robot can have done. */
typedef struct {
    ale_pose_t centre;
    int32_t reach_um;   /* to either side along x and y; ALE_VOTE_REACH_UM at most */
    int32_t reach_urad; /* of the heading; half a turn: any */
} ale_vote_region_t;

/* Working memory. */
typedef struct {
    ale_likelihood_grid_t grid;
    ale_point_t point[ALE_VOTE_POINTS]; /* of the scan, robot's frame */
    uint32_t points;
    int32_t cell[ALE_VOTE_POINTS]; /* of the points at a heading */
    uint32_t turned;
    uint8_t sum[ALE_VOTE_CELLS];             /* row by row; ALE_VOTE_POINTS * ALE_GRID_SURFACE at most */
    ale_voted_pose_t place[ALE_VOTE_PLACES]; /* distinct, best first */
    uint32_t places;
} ale_pose_vote_t;

/* Finds the places of a region that explain the observations best: vote->place. The near walls of the map are
 * prepared (ale_local_map_approach). */
void ale_pose_vote(ale_pose_vote_t *vote, const ale_local_map_t *map, const ale_observation_t observation[],
                   uint32_t count, const ale_vote_region_t *region);

#endif
