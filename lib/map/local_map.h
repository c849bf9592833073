/* The map: walls in bounded memory, and quick access to those around the robot.
 *
 * Walls lie in one array without gaps. Those near the robot are listed by the direction of their normal,
 * so that an observation is compared only with walls that face the same way; the list is made anew when the
 * robot has gone on or the map has changed, in time bounded by the capacity. One owner. */
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

/* What a first look at a wall asks for, packed: most walls that are looked at are dismissed by it. */
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
    uint16_t chosen[ALE_MAP_MAX_LINES];           /* working memory of the listing */
    ale_candidate_t candidate[ALE_MAP_MAX_LINES]; /* those of them that a scan may show, in the same order */
    uint16_t candidate_first[ALE_MAP_DIRECTIONS + 1];
    ale_point_t near_centre;
    int32_t near_radius_um; /* 0: to be made anew */
} ale_local_map_t;

void ale_local_map_clear(ale_local_map_t *map);

/* Prepares the list of walls that a sensor at `centre` with this reach can see. O(1) as a rule, O(map)
 * when the robot has gone a metre or walls came and went. */
void ale_local_map_approach(ale_local_map_t *map, ale_point_t centre, int32_t reach_um);

/* Of the near walls those within reach of a place: what ale_associate looks at until the next call. As the
 * walls are now; while a scan moves them a little, so far off. O(near walls), a few instructions each. */
void ale_local_map_focus(ale_local_map_t *map, ale_point_t centre, int32_t reach_um);

/* The ranges of a list by direction (near[], glance[] with their first[]) that hold the walls facing within
 * `reach` buckets of a direction, 31 at most; the second is empty unless the list wraps. */
void ale_local_map_facing(const uint16_t first[ALE_MAP_DIRECTIONS + 1], uint32_t normal_bam, int32_t reach,
                          ale_range_t out[2]);
int32_t ale_local_map_bucket(uint32_t normal_bam);

/* Shortens a range to the looks that are left, and takes them. */
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

/* Joins a near wall with another one that continues or repeats it, if there is one. True when it did. looks:
 * as for ale_associate. */
bool ale_local_map_merge_at(ale_local_map_t *map, uint16_t index, int32_t *work);

#endif
