#include "track/correction.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    /* How well a corrected wall lies to those it was moved to: what a loop is known by. */
    LOOP_OFFSET_UM2 = 400000000, /* (20 mm)^2 */
    LOOP_ANGLE_URAD2 = 64000000, /* (8 mrad)^2 */
    MOVED_UM = 5000,             /* less is no news to a wall */
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

static void correct_wall(ale_wall_t *wall, ale_pose_t shift)
{
    const ale_point_t before = wall->anchor;
    wall->anchor = ale_pose_apply(shift, wall->anchor);
    ale_wall_set_normal(wall, wall->normal_bam + shift.theta_bam);
    const ale_point_t way = ale_minus(wall->anchor, before);
    if (ale_abs64(way.x_um) > MOVED_UM || ale_abs64(way.y_um) > MOVED_UM ||
        ale_abs64((int32_t)shift.theta_bam) > MOVED_BAM) {
        wall->var_offset_um2 += LOOP_OFFSET_UM2;
        wall->var_angle_urad2 += LOOP_ANGLE_URAD2;
    }
}

/* Marks are found by where they lie: all are entered anew. */
static void correct_marks(ale_landmarks_t *landmarks, const ale_correction_t *correction,
                          ale_landmarks_t *spare)
{
    *spare = *landmarks;
    ale_landmarks_clear(landmarks);
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        ale_landmark_t landmark = spare->landmark[i];
        if (landmark.seen > 0) {
            const ale_pose_t shift = ale_correction_at(correction, landmark.born);
            landmark.p = ale_pose_apply(shift, landmark.p);
            landmark.normal_bam += shift.theta_bam;
            ale_landmarks_add(landmarks, &landmark);
        }
    }
}

static void correct_corners(ale_map_corners_t *corners, const ale_correction_t *correction)
{
    for (uint32_t i = 0; i < corners->count; i++) {
        const ale_pose_t shift = ale_correction_at(correction, corners->born[i]);
        corners->corner[i].p = ale_pose_apply(shift, corners->corner[i].p);
        corners->corner[i].bisector_bam += shift.theta_bam;
    }
}

void ale_local_map_correct(ale_local_map_t *map, const ale_correction_t *correction, ale_landmarks_t *spare)
{
    for (uint32_t i = 0; i < map->count; i++) {
        correct_wall(&map->wall[i], ale_correction_at(correction, map->wall[i].born));
    }
    correct_marks(&map->landmarks, correction, spare);
    correct_corners(&map->corners, correction);
    map->near_radius_um = 0;
    map->version++;
}
