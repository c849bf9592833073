/* The map in bounded memory, with quick access to the walls around the robot.
 *
 * Walls lie in one array without gaps. The near list holds those around the robot by the direction of their
 * normal, so that an observation is compared only with walls that face the same way. It is rebuilt when the
 * robot has moved a metre or walls came and went, in time bounded by the capacity. One owner. */
#ifndef ALE_MAP_LOCAL_MAP_H
#define ALE_MAP_LOCAL_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "map/landmarks.h"
#include "map/line_map.h"
#include "map/map_corner.h"
#include "map/wall.h"

enum {
    ALE_MAP_DIRECTIONS = 64, /* buckets of the near list: 5.6 degrees each */
    ALE_MAP_CONFIRMED = 3,   /* scans after which a wall counts as real */
    ALE_NO_WALL = 0xffff
};

/* The line of a wall, packed for the first test of an association, which dismisses most walls. */
typedef struct {
    int64_t offset_q30; /* of the wall's line along its normal, from the map's origin, um */
    int32_t normal_x_q30;
    int32_t normal_y_q30;
    uint16_t wall;
} ale_candidate_t;

/* A range of a list, last excluded. */
typedef struct {
    uint16_t first;
    uint16_t last;
} ale_range_t;

typedef struct {
    ale_wall_t wall[ALE_MAP_MAX_LINES];
    uint16_t count;
    uint32_t next_id;
    uint32_t version;
    uint32_t refused;          /* walls that found no room */
    ale_landmarks_t landmarks; /* where there are no walls */
    ale_map_corners_t corners;

    uint16_t near[ALE_MAP_MAX_LINES]; /* walls around near_centre, by direction of their normal */
    uint16_t near_first[ALE_MAP_DIRECTIONS + 1];
    uint16_t chosen[ALE_MAP_MAX_LINES];           /* working memory of ale_local_map_approach */
    ale_candidate_t candidate[ALE_MAP_MAX_LINES]; /* of the near walls those in focus, in the same order */
    uint16_t candidate_first[ALE_MAP_DIRECTIONS + 1];
    ale_point_t near_centre;
    int32_t near_radius_um; /* 0: to be made anew */
    uint8_t selected;       /* the map whose walls and landmarks are found, and that new ones belong to */
} ale_local_map_t;

void ale_local_map_clear(ale_local_map_t *map);

/* From here on walls and landmarks of this map alone are found, and what is added belongs to it (see
 * atlas.h). ale_local_map_approach must follow. O(1). */
void ale_local_map_select(ale_local_map_t *map, uint8_t number);

/* Removes all walls, landmarks and corners of a map. O(map). */
void ale_local_map_give_up(ale_local_map_t *map, uint8_t number);

/* Prepares the list of walls that a sensor at `centre` with this reach can see. O(1) as a rule, O(map)
 * when the robot has gone a metre or walls came and went. */
void ale_local_map_approach(ale_local_map_t *map, ale_point_t centre, int32_t reach_um);

/* Selects the near walls within reach of a place as the candidates of ale_associate until the next call, as
 * they lie now: later updates of a wall do not move its candidate. O(near walls), a few instructions each. */
void ale_local_map_focus(ale_local_map_t *map, ale_point_t centre, int32_t reach_um);

/* The ranges of a list by direction (near[], candidate[] with their first[]) that hold the walls facing
 * within `reach` buckets of a direction, 31 at most; the second is empty unless the list wraps. */
void ale_local_map_facing(const uint16_t first[ALE_MAP_DIRECTIONS + 1], uint32_t normal_bam, int32_t reach,
                          ale_range_t out[2]);
int32_t ale_local_map_bucket(uint32_t normal_bam);

/* Shortens a range to the work that is left, and spends it. */
static inline void ale_spend_work(ale_range_t *range, int32_t *work)
{
    const int32_t size = range->last - range->first;
    const int32_t most = *work < size ? (*work > 0 ? *work : 0) : size;
    range->last = (uint16_t)(range->first + most);
    *work -= most;
}

/* How many buckets to either side hold all directions within an angle. */
int32_t ale_local_map_buckets(int32_t angle_urad);

/* Adds a wall and gives it an id. When the map is full the oldest unconfirmed wall makes room; when there
 * is none the wall is refused and counted. Returns its index or ALE_NO_WALL. */
uint16_t ale_local_map_add(ale_local_map_t *map, const ale_wall_t *wall);

/* Removes a wall: the last one takes its place. */
void ale_local_map_remove(ale_local_map_t *map, uint16_t index);

/* Merges a near wall with another one that continues or repeats it. True: one was found, and the walls have
 * new indices. *work: as for ale_associate. */
bool ale_local_map_merge_at(ale_local_map_t *map, uint16_t index, int32_t *work);

#endif
