#include "map/local_map.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    NEAR_MARGIN_UM = 2000000, /* the list covers more than the reach, and is valid for the next metre */
    NEAR_STEP_UM = 1000000,
    BUCKET_SHIFT = 26,
    BUCKET_URAD = 98175,
    MERGE_ANGLE_URAD = 35000,
    MERGE_OFFSET_UM = 25000,
    APART_UM = 60000, /* farther off, over the whole length */
    MERGE_GATE = 9    /* squared sigmas */
};

void ale_local_map_clear(ale_local_map_t *map)
{
    map->count = 0;
    map->next_id = 0;
    map->version = 0;
    map->refused = 0;
    map->near_radius_um = 0;
    map->selected = 0;
    ale_landmarks_clear(&map->landmarks);
    ale_map_corners_clear(&map->corners);
}

void ale_local_map_select(ale_local_map_t *map, uint8_t number)
{
    map->near_radius_um = map->selected == number ? map->near_radius_um : 0;
    map->selected = map->landmarks.selected = map->corners.selected = number;
}

void ale_local_map_give_up(ale_local_map_t *map, uint8_t number)
{
    for (uint16_t i = map->count; i > 0; i--) {
        if (map->wall[i - 1].map == number) {
            ale_local_map_remove(map, (uint16_t)(i - 1));
        }
    }
    ale_landmarks_give_up(&map->landmarks, number);
    ale_map_corners_give_up(&map->corners, number);
}

int32_t ale_local_map_bucket(uint32_t normal_bam)
{
    return (int32_t)(normal_bam >> BUCKET_SHIFT);
}

int32_t ale_local_map_buckets(int32_t angle_urad)
{
    return angle_urad / BUCKET_URAD + 1;
}

/* Whether some of the wall's bounding box lies within the square of half width `reach` around the centre.
 * Where the anchor is, and how long the wall, decides for most. */
static bool reaches_in(const ale_wall_t *wall, ale_point_t centre, int64_t reach_um)
{
    const ale_point_t a = ale_minus(ale_wall_point(wall, wall->start_um), centre);
    const ale_point_t b = ale_minus(ale_wall_point(wall, wall->end_um), centre);
    return ale_min64(a.x_um, b.x_um) < reach_um && ale_max64(a.x_um, b.x_um) > -reach_um &&
           ale_min64(a.y_um, b.y_um) < reach_um && ale_max64(a.y_um, b.y_um) > -reach_um;
}

static inline bool is_near(const ale_wall_t *wall, ale_point_t centre, int64_t reach_um)
{
    const int64_t off_um = ale_max64(ale_abs64((int64_t)wall->anchor.x_um - centre.x_um),
                                     ale_abs64((int64_t)wall->anchor.y_um - centre.y_um));
    if (off_um < reach_um && wall->start_um <= 0 && wall->end_um >= 0) {
        return true;
    }
    const int64_t most_um = ale_max64(ale_abs64(wall->start_um), ale_abs64(wall->end_um));
    return off_um - most_um < reach_um && reaches_in(wall, centre, reach_um);
}

/* Counting sort of the near walls by bucket. */
static void list_near(ale_local_map_t *map)
{
    uint16_t next[ALE_MAP_DIRECTIONS];
    uint16_t found = 0;
    uint16_t size[ALE_MAP_DIRECTIONS] = {0};
    for (uint16_t i = 0; i < map->count; i++) {
        if (map->wall[i].map == map->selected &&
            is_near(&map->wall[i], map->near_centre, map->near_radius_um)) {
            map->chosen[found++] = i;
            size[ale_local_map_bucket(map->wall[i].normal_bam)]++;
        }
    }
    uint16_t sum = 0;
    for (int b = 0; b < ALE_MAP_DIRECTIONS; b++) {
        map->near_first[b] = next[b] = sum;
        sum = (uint16_t)(sum + size[b]);
    }
    map->near_first[ALE_MAP_DIRECTIONS] = sum;
    for (uint16_t k = 0; k < found; k++) {
        const int32_t b = ale_local_map_bucket(map->wall[map->chosen[k]].normal_bam);
        map->near[next[b]++] = map->chosen[k];
    }
}

void ale_local_map_approach(ale_local_map_t *map, ale_point_t centre, int32_t reach_um)
{
    const int32_t radius_um = (int32_t)ale_min64((int64_t)reach_um + NEAR_MARGIN_UM, INT32_MAX);
    const bool moved = ale_abs64((int64_t)centre.x_um - map->near_centre.x_um) > NEAR_STEP_UM ||
                       ale_abs64((int64_t)centre.y_um - map->near_centre.y_um) > NEAR_STEP_UM;
    if (!moved && map->near_radius_um == radius_um) {
        return;
    }
    map->near_centre = centre;
    map->near_radius_um = radius_um;
    list_near(map);
}

void ale_local_map_focus(ale_local_map_t *map, ale_point_t centre, int32_t reach_um)
{
    uint16_t count = 0;
    for (int b = 0; b < ALE_MAP_DIRECTIONS; b++) {
        map->candidate_first[b] = count;
        for (uint16_t k = map->near_first[b]; k < map->near_first[b + 1]; k++) {
            const ale_wall_t *wall = &map->wall[map->near[k]];
            if (is_near(wall, centre, reach_um)) {
                map->candidate[count++] =
                    (ale_candidate_t){.offset_q30 = (int64_t)wall->anchor.x_um * wall->normal_x_q30 +
                                                    (int64_t)wall->anchor.y_um * wall->normal_y_q30,
                                      .normal_x_q30 = wall->normal_x_q30,
                                      .normal_y_q30 = wall->normal_y_q30,
                                      .wall = map->near[k]};
            }
        }
    }
    map->candidate_first[ALE_MAP_DIRECTIONS] = count;
}

void ale_local_map_facing(const uint16_t first[ALE_MAP_DIRECTIONS + 1], uint32_t normal_bam, int32_t reach,
                          ale_range_t out[2])
{
    const uint32_t from = (uint32_t)(ale_local_map_bucket(normal_bam) - reach) % ALE_MAP_DIRECTIONS;
    const uint32_t to = from + 2 * (uint32_t)reach + 1;
    const uint32_t end = to < ALE_MAP_DIRECTIONS ? to : ALE_MAP_DIRECTIONS;
    out[0] = (ale_range_t){first[from], first[end]};
    out[1] = (ale_range_t){0, first[to - end]};
}

static uint16_t oldest_unconfirmed(const ale_local_map_t *map)
{
    uint16_t found = ALE_NO_WALL;
    for (uint16_t i = 0; i < map->count; i++) {
        const bool candidate = map->wall[i].seen < ALE_MAP_CONFIRMED;
        if (candidate && (found == ALE_NO_WALL || map->wall[i].last_scan < map->wall[found].last_scan)) {
            found = i;
        }
    }
    return found;
}

uint16_t ale_local_map_add(ale_local_map_t *map, const ale_wall_t *wall)
{
    uint16_t index = map->count;
    if (index == ALE_MAP_MAX_LINES) {
        index = oldest_unconfirmed(map);
        if (index == ALE_NO_WALL) {
            map->refused++;
            return ALE_NO_WALL;
        }
    } else {
        map->count++;
    }
    map->wall[index] = *wall;
    map->wall[index].id = map->next_id++;
    map->wall[index].map = map->selected;
    map->near_radius_um = 0;
    return index;
}

void ale_local_map_remove(ale_local_map_t *map, uint16_t index)
{
    map->count--;
    map->wall[index] = map->wall[map->count];
    map->near_radius_um = 0;
    map->version++;
}

/* How the wall `other` lies to `wall`: as if it were an observation from the origin of the map. */
static ale_wall_error_t between_walls(const ale_wall_t *wall, const ale_wall_t *other)
{
    const ale_observation_t as_observation = {.centre = other->anchor,
                                              .normal_bam = other->normal_bam,
                                              .start_um = other->start_um,
                                              .end_um = other->end_um};
    return ale_wall_error(wall, &as_observation);
}

/* The same wall: they overlap, and differ by no more than their errors. */
static bool is_same(const ale_wall_t *wall, const ale_wall_t *other, const ale_wall_error_t *e)
{
    if (e->overlap_um < 0 || ale_abs64(e->angle_urad) > MERGE_ANGLE_URAD) {
        return false;
    }
    /* errors where they overlap, from the end of the wall that is common */
    const int64_t middle_um = (ale_min64(wall->end_um, e->t_um + other->end_um) +
                               ale_max64(wall->start_um, e->t_um + other->start_um)) /
                              2;
    const int64_t offset_um = e->offset_um + (middle_um - e->t_um) * e->angle_urad / 1000000;
    const int64_t var =
        ale_wall_offset_var(wall, middle_um) + ale_wall_offset_var(other, middle_um - e->t_um);
    const int64_t var_angle = wall->var_angle_urad2 + other->var_angle_urad2;
    return ale_abs64(offset_um) < MERGE_OFFSET_UM && offset_um * offset_um < MERGE_GATE * var &&
           e->angle_urad * e->angle_urad < MERGE_GATE * var_angle;
}

/* Neither end of one wall is within reach of the other's line, both ends on one side of it: they cannot be
 * the same, however long they are. */
static bool are_apart(const ale_wall_t *a, const ale_wall_t *b)
{
    const int64_t start_um = ale_wall_offset(a, ale_wall_point(b, b->start_um));
    const int64_t end_um = ale_wall_offset(a, ale_wall_point(b, b->end_um));
    return ale_min64(start_um, end_um) > APART_UM || ale_max64(start_um, end_um) < -APART_UM;
}

/* Of the walls of a map of tiles each leaves by itself: none goes for another. */
static bool are_of_tiles(const ale_wall_t *a, const ale_wall_t *b)
{
    return a->prior_id != 0 && b->prior_id != 0;
}

/* Of two walls that are one, the one that stays: that of tiles, else the older one. */
static bool goes_first(const ale_wall_t *a, const ale_wall_t *b)
{
    return a->prior_id != 0 || (b->prior_id == 0 && a->id < b->id);
}

static void join(ale_wall_t *keep, const ale_wall_t *other, const ale_wall_error_t *e)
{
    ale_wall_observe(keep, e, other->var_offset_um2, other->var_angle_urad2);
    ale_wall_extend(keep, e->t_um + other->start_um, e->t_um + other->end_um);
    keep->seen += other->seen;
    keep->last_scan = (uint32_t)ale_max64(keep->last_scan, other->last_scan);
    keep->missed = (uint16_t)ale_min64(keep->missed, other->missed);
}

bool ale_local_map_merge_at(ale_local_map_t *map, uint16_t index, int32_t *work)
{
    ale_range_t facing[2];
    ale_local_map_facing(map->near_first, map->wall[index].normal_bam, 1, facing);
    for (int r = 0; r < 2; r++) {
        ale_spend_work(&facing[r], work);
        for (uint16_t k = facing[r].first; k < facing[r].last; k++) {
            const uint16_t other = map->near[k];
            if (other == index || are_apart(&map->wall[index], &map->wall[other]) ||
                are_of_tiles(&map->wall[index], &map->wall[other])) {
                continue;
            }
            const bool first = goes_first(&map->wall[other], &map->wall[index]);
            const uint16_t keep = first ? other : index;
            const uint16_t gone = first ? index : other;
            const ale_wall_error_t e = between_walls(&map->wall[keep], &map->wall[gone]);
            if (is_same(&map->wall[keep], &map->wall[gone], &e)) {
                join(&map->wall[keep], &map->wall[gone], &e);
                ale_local_map_remove(map, gone);
                return true;
            }
        }
    }
    return false;
}
