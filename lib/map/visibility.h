/* Visibility: whether a scan supports a wall, violates it by seeing through it, or cannot tell.
 *
 * A wall that is violated again and again is no longer there: it decays from the map. A robot whose scan
 * violates most walls in view is not where it believes to be. Constant work per wall. Test: rays in double,
 * test_visibility.cpp. */
#ifndef ALE_MAP_VISIBILITY_H
#define ALE_MAP_VISIBILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "map/wall.h"
#include "observe/posed_scan.h"

typedef enum {
    ALE_VISIBILITY_NONE,      /* out of view, too grazing, hidden, or no value in the beams */
    ALE_VISIBILITY_SUPPORTED, /* something stands where the wall is */
    ALE_VISIBILITY_VIOLATED   /* the beams go on beyond it */
} ale_visibility_t;

/* Of ALE_VISIBILITY_POINTS points of a wall: how many are supported, and how many are violated. */
enum { ALE_VISIBILITY_POINTS = 3 };
typedef struct {
    uint8_t supported;
    uint8_t violated;
} ale_points_visibility_t;

/* Allowance for the error of the sensor's pose, beyond the fixed tolerance. It widens the tolerance of the
 * range and adds beams beside the one meant: one of them supports, all must violate. same_place: the surface
 * was observed from where the scan was taken, so the tolerance is smaller, and a beam without return
 * violates. */
typedef struct {
    int32_t offset_um;
    int32_t angle_urad;
    bool same_place;
} ale_slack_t;

/* The longest range of a scan. O(beams). */
int64_t ale_farthest_um(const ale_scan_t *scan);

/* Whether the wall faces the sensor, and some of it may lie nearer than the farthest of what is seen. */
static inline bool ale_wall_may_be_in_view(const ale_wall_t *wall, ale_pose_t sensor, int64_t farthest_um)
{
    const int64_t most_um = farthest_um + wall->end_um - wall->start_um;
    return ale_abs64((int64_t)wall->anchor.x_um - sensor.x_um) < most_um &&
           ale_abs64((int64_t)wall->anchor.y_um - sensor.y_um) < most_um &&
           ale_wall_offset(wall, (ale_point_t){sensor.x_um, sensor.y_um}) > 0;
}

/* Visibility of three evenly spaced points. from: sensor pose in the frame of the wall, here and below. */
ale_points_visibility_t ale_wall_points_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from,
                                                   ale_slack_t slack);

/* Of a wall as a whole, without allowance: supported by one of the three points, violated by two. */
ale_visibility_t ale_wall_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from);

/* Of the point at t_um along the wall's tangent, without allowance. */
ale_visibility_t ale_wall_point_visibility(const ale_wall_t *wall, int64_t t_um,
                                           const ale_posed_scan_t *from);

#endif
