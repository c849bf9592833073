/* Exploration: sees all that the robot can reach, then drives back to where it began. Or drives to a place.
 *
 *   ale_explorer_init(explorer, &config);
 *   ale_explorer_request(explorer, true);
 *   velocity = ale_explorer_step(explorer, &scan, &estimate, now_us);      every scan
 *
 *   OFF -- on --> EXPLORING -- nothing left to see --> RETURNING -- at the start --> TURNING --> FINISHED
 *                   any of them -- off --> OFF;  a path home that stays closed --> BLOCKED, until it opens
 *                   any of them but OFF and FINISHED -- loops moved the map --> EXPLORING
 *
 *   any -- to a place --> GOING -- there --> ARRIVED;  no way, and why --> GIVEN_UP
 *
 * The grid begins anew with every "on" and with every new map; when loops have moved the map, it is drawn
 * again from the scans kept. A place is driven to through what the map and the scans since leave open, also
 * through what has not been seen; its coordinates stay those of the map. While the pose is lost the robot
 * stands, then drives to where it can be told (wander.h), and goes on once it is found; on the way to a place
 * it only stands. Goals that it cannot get to are given up and counted.
 *
 * No function fails or allocates; every loop is bounded by the grid's capacity. The memory is the caller's:
 * sizeof(ale_explorer_t), some 30 MB. One owner thread, never the estimate task: a step in which paths are
 * planned takes some 10 ms of a PC. Lengths um, velocities um/s and urad/s. */
#ifndef ALE_PLAN_EXPLORER_H
#define ALE_PLAN_EXPLORER_H

#include "map/line_map.h"
#include "plan/follower.h"
#include "plan/grid.h"
#include "plan/kept_scans.h"
#include "plan/planner.h"
#include "plan/wander.h"
#include "track/correction.h"
#include "track/estimate.h"

typedef struct {
    ale_follower_t follower; /* shape, mounting, speeds */
    int32_t clearance_um;    /* room that planned paths keep beyond width and margin; 0 or more */
} ale_explorer_config_t;

/* The robot of robot_shape.h with its scanner in the middle. */
ale_explorer_config_t ale_explorer_default_config(void);

typedef enum {
    ALE_EXPLORER_OFF,
    ALE_EXPLORER_EXPLORING,
    ALE_EXPLORER_RETURNING,
    ALE_EXPLORER_TURNING,
    ALE_EXPLORER_FINISHED,
    ALE_EXPLORER_BLOCKED,
    ALE_EXPLORER_GOING,
    ALE_EXPLORER_ARRIVED,
    ALE_EXPLORER_GIVEN_UP
} ale_explorer_state_t;

/* Why a place was given up. */
typedef enum {
    ALE_GIVEN_UP_NOT,
    ALE_GIVEN_UP_LOST,   /* the pose is lost */
    ALE_GIVEN_UP_FAR,    /* beyond the grid */
    ALE_GIVEN_UP_TAKEN,  /* no room there for the robot */
    ALE_GIVEN_UP_CLOSED, /* no way there */
    ALE_GIVEN_UP_STUCK,  /* no progress on the way */
    ALE_GIVEN_UP_MAP     /* another map has begun */
} ale_given_up_t;

/* Walls of a map, as far as a path must know them. */
typedef struct {
    uint16_t count;
    ale_point_t start[ALE_MAP_MAX_LINES];
    ale_point_t end[ALE_MAP_MAX_LINES];
    uint32_t map_id[ALE_MAP_MAX_LINES];
} ale_plan_walls_t;

typedef struct {
    ale_explorer_config_t config;
    ale_explorer_state_t state;
    bool begun;             /* home is known, the grid is about it */
    uint32_t epoch;         /* of the map that it explores */
    uint32_t home_scan;     /* in which it was switched on */
    uint32_t scan;          /* the newest one */
    ale_pose_t home;        /* where it was switched on, map frame; or the place that it drives to */
    ale_given_up_t why;     /* GIVEN_UP */
    uint32_t map_id;        /* of the map that it drives in */
    ale_plan_walls_t walls; /* of the map, while it drives to a place */
    ale_pose_t pose;        /* where the robot is now */
    uint32_t steps_since_plan;
    uint32_t plans_without_goal;
    ale_route_t route;
    ale_cell_t goal;         /* of the path before, ALE_GRID_NONE: none */
    ale_point_t progress_at; /* where the robot last made progress */
    uint32_t steps_without_progress;
    uint32_t steps_stuck; /* the path ahead is closed */
    uint32_t steps_back;  /* still to be driven backwards */
    ale_wander_t wander;  /* while the pose is lost */
    ale_grid_t grid;
    ale_planner_t planner;
    ale_kept_scans_t kept;
    ale_straight_scan_t straightened;
} ale_explorer_t;

/* Off, with nothing known. The configuration is copied. Constant time. */
void ale_explorer_init(ale_explorer_t *explorer, const ale_explorer_config_t *config);

/* Neither off nor finished, there, or given up. */
bool ale_explorer_is_active(const ale_explorer_t *explorer);

/* On: begins anew, unless it is active; off: stops. Constant time; the grid is cleared by the next step. */
void ale_explorer_request(ale_explorer_t *explorer, bool on);

/* Drives to `place` of the map that it is in, from the next step on, whatever it did. map: its walls, copied;
 * NULL: none are known. O(lines). */
void ale_explorer_go(ale_explorer_t *explorer, ale_point_t place, const ale_map_t *map);

/* Loops have moved the map, and the next estimate is of the map as it is now: grid, home and all that it
 * remembers move with it. Each correction once, in order; one made for another map is ignored, and so are all
 * while it is not active. The correction is read during the call alone. O(ALE_KEPT_SCANS), and part of a
 * second where the grid has to be drawn again. */
void ale_explorer_correct(ale_explorer_t *explorer, const ale_correction_t *correction);

/* One scan (blind sectors masked) with its estimate; now_us, of the same clock, is when the velocity will be
 * in force. Returns what to drive; all zero when there is nothing to do. scan and estimate are read during
 * the call alone. O(beams * reach / cell), every fifth step O(cells seen). */
ale_velocity_t ale_explorer_step(ale_explorer_t *explorer, const ale_scan_t *scan,
                                 const ale_estimate_t *estimate, int64_t now_us);

#endif
