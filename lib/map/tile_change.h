/* Part of a map of tiles that comes into the map in work, or leaves it, as the robot goes on.
 *
 *   whereabouts, now and then ──► tile loader ──► changes, in pieces ──► ale_tile_change_apply
 *
 * A wall of the stored map has a number there that is its own and not 0, its `prior_id`; by that it leaves
 * again. What the drive itself has seen leaves when it lies outside the tiles that are loaded. So what is in
 * work is bounded, however large the stored map is, and however far the robot goes. */
#ifndef ALE_MAP_TILE_CHANGE_H
#define ALE_MAP_TILE_CHANGE_H

#include <stdbool.h>
#include <stdint.h>

#include "map/line_map.h"
#include "map/local_map.h"
#include "map/tile_grid.h"

/* The robot says where it is with every so many scans, and what follows from it is due so many scans later:
 * a second and a half at 10 Hz. The loader works within that, as a rule. */
enum { ALE_WHEREABOUTS_SCANS = 5, ALE_TILE_DELAY_SCANS = 10 };

/* A robot at 2 m/s goes so far, and more, before what it asks for is there. */
enum { ALE_TILE_MARGIN_UM = 6000000 };

/* Of the stored map in work at once; the rest of the capacity is for what the drive sees, and for maps that
 * are not joined. */
enum { ALE_TILE_WALLS = 1536, ALE_TILE_CORNERS = 768 };

/* In one piece. */
enum { ALE_TILE_PIECE_WALLS = 32, ALE_TILE_PIECE_CORNERS = 32 };

/* Where the robot is, for the loader. */
typedef struct ale_whereabouts {
    uint32_t epoch; /* of the map: see ale_estimate_t */
    uint32_t scan;
    ale_pose_t pose;  /* map frame; of a robot that is lost, as far as it has gone since */
    int64_t reach_um; /* within it everything should be loaded */
} ale_whereabouts_t;

/* One piece of a change: those of one change come one after another, and the last one says so. */
typedef struct ale_tile_change {
    uint32_t epoch; /* of the map that it is for */
    uint32_t due;   /* the scan before which it takes effect; later when it comes too late */
    bool last;
    bool whole;       /* with the last piece: nothing of the stored map is missing */
    ale_box_t window; /* of the tiles that are loaded from the last piece on */
    uint16_t gone_count;
    uint16_t line_count;
    uint16_t corner_count;
    uint32_t gone[ALE_TILE_PIECE_WALLS]; /* prior_id, ascending */
    ale_map_line_t line[ALE_TILE_PIECE_WALLS];
    ale_map_corner_t corner[ALE_TILE_PIECE_CORNERS];
} ale_tile_change_t;

/* Takes one piece into the first map. A wall that comes takes the place of what the drive has seen of it,
 * should it have been there before. What finds no room is counted as refused. O(lines of the piece * map):
 * what that comes to is in the bound of `make wcet`. */
void ale_tile_change_apply(ale_local_map_t *map, const ale_tile_change_t *change);

#endif
