#include "track/correction.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    /* How well a corrected wall lies to those it was moved to: what a loop is known by. */
    LOOP_OFFSET_UM2 = 400000000, /* (20 mm)^2 */
    LOOP_ANGLE_URAD2 = 64000000, /* (8 mrad)^2 */
    MOVED_UM = 5000,             /* less is no news: walls and robot are not known better */
    MOVED_BAM = 2 * ALE_BAM_PER_MRAD
};

ale_pose_t ale_correction_at(const ale_correction_t *correction, uint32_t scan)
{
    uint32_t low = 0; /* shifts before low are of scans <= scan, those from high on are not */
    uint32_t high = correction->count;
    if (scan == ALE_BORN_BEFORE) {
        return (ale_pose_t){0, 0, 0};
    }
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (correction->shift[middle].scan <= scan) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low > 0 ? correction->shift[low - 1].shift : (ale_pose_t){0, 0, 0};
}

ale_pose_t ale_correction_in(const ale_correction_t *correction, uint32_t scan, const ale_moved_map_t *moved)
{
    const ale_pose_t shift = ale_correction_at(correction, scan);
    const bool before = correction->shift[correction->count - 1].scan < moved->to_scan;
    if (!before || scan < moved->from_scan || scan >= moved->to_scan) {
        return shift;
    }
    const ale_pose_t back = ale_pose_between(moved->shift, (ale_pose_t){0, 0, 0});
    return ale_pose_compose(ale_pose_compose(moved->shift, shift), back);
}

bool ale_correction_is_news(ale_point_t before, ale_point_t after, ale_pose_t shift)
{
    return ale_abs64((int64_t)after.x_um - before.x_um) > MOVED_UM ||
           ale_abs64((int64_t)after.y_um - before.y_um) > MOVED_UM ||
           ale_abs64((int32_t)shift.theta_bam) > MOVED_BAM;
}

static void move_wall(ale_wall_t *wall, ale_pose_t shift)
{
    const ale_point_t before = wall->anchor;
    wall->anchor = ale_pose_apply(shift, wall->anchor);
    ale_wall_set_normal(wall, wall->normal_bam + shift.theta_bam);
    if (ale_correction_is_news(before, wall->anchor, shift)) {
        wall->var_offset_um2 += LOOP_OFFSET_UM2;
        wall->var_angle_urad2 += LOOP_ANGLE_URAD2;
    }
}

/* By what something moves that was first seen in a scan: a correction, or a join. */
typedef struct {
    const ale_correction_t *correction; /* NULL: the join */
    const ale_moved_map_t *moved;
    const ale_local_map_join_t *join;
} move_t;

static ale_pose_t shift_of(const move_t *move, uint32_t born, uint8_t *map)
{
    if (move->correction) {
        return ale_correction_in(move->correction, born, move->moved);
    }
    const bool joins = *map == move->join->from;
    *map = joins ? move->join->into : *map;
    return joins ? move->join->shift : (ale_pose_t){0, 0, 0};
}

/* Landmarks are found by where they lie: all are entered anew. */
static void move_landmarks(ale_landmarks_t *landmarks, const move_t *move, ale_landmarks_t *spare)
{
    *spare = *landmarks;
    ale_landmarks_clear(landmarks);
    landmarks->selected = spare->selected;
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        ale_landmark_t landmark = spare->landmark[i];
        if (landmark.seen > 0) {
            const ale_pose_t shift = shift_of(move, landmark.born, &landmark.map);
            landmark.p = ale_pose_apply(shift, landmark.p);
            landmark.normal_bam += shift.theta_bam;
            ale_landmarks_add(landmarks, &landmark);
        }
    }
}

static void move_corners(ale_map_corners_t *corners, const move_t *move)
{
    for (uint32_t i = 0; i < corners->count; i++) {
        const ale_pose_t shift = shift_of(move, corners->born[i], &corners->map[i]);
        corners->corner[i].p = ale_pose_apply(shift, corners->corner[i].p);
        corners->corner[i].bisector_bam += shift.theta_bam;
    }
}

static void move_map(ale_local_map_t *map, const move_t *move, ale_landmarks_t *spare)
{
    for (uint32_t i = 0; i < map->count; i++) {
        move_wall(&map->wall[i], shift_of(move, map->wall[i].born, &map->wall[i].map));
    }
    move_landmarks(&map->landmarks, move, spare);
    move_corners(&map->corners, move);
    map->near_radius_um = 0;
    map->version++;
}

void ale_local_map_correct(ale_local_map_t *map, const ale_correction_t *correction,
                           const ale_moved_map_t *moved, ale_landmarks_t *spare)
{
    move_map(map, &(move_t){correction, moved, NULL}, spare);
}

void ale_local_map_join(ale_local_map_t *map, const ale_local_map_join_t *join, ale_landmarks_t *spare)
{
    for (uint32_t i = 0; i < map->count; i++) {
        if (map->wall[i].map == join->from) {
            map->wall[i].map_uncertainty = join->map_uncertainty;
        }
    }
    move_map(map, &(move_t){NULL, NULL, join}, spare);
}
