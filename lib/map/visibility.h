/* Whether a scan sees a wall of the map, sees through where it should be, or cannot tell.
 *
 * What is seen through again and again is no longer there: it fades from the map. And a robot that sees
 * through most of what it should see is not where it believes to be. Constant work a wall. */
#ifndef ALE_MAP_VISIBILITY_H
#define ALE_MAP_VISIBILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "map/wall.h"
#include "observe/posed_scan.h"

typedef enum {
    ALE_VISIBILITY_NONE,      /* out of view, too grazing, hidden, or no value in the beams */
    ALE_VISIBILITY_SUPPORTED, /* something stands where the wall is */
    ALE_VISIBILITY_VIOLATED   /* the beams go on beyond it */
} ale_visibility_t;

/* How many points of a wall, of ALE_VISIBILITY_POINTS that are asked, are there and are seen through. */
enum { ALE_VISIBILITY_POINTS = 3 };
typedef struct {
    uint8_t supported;
    uint8_t violated;
} ale_points_visibility_t;

/* How far the sensor's pose may be off, beyond what is always allowed for. same_place: the surface was seen
 * from where the scan was taken; what a map errs need not be allowed for, and where it gave an answer then,
 * no answer means that it is not there. */
typedef struct {
    int32_t offset_um;
    int32_t angle_urad;
    bool same_place;
} ale_slack_t;

ale_points_visibility_t ale_wall_points_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from,
                                                   ale_slack_t slack);

/* What a straightened scan, taken by a sensor at a pose of the map, says of a wall. bearing_bam as for
 * ale_extract_scan. Three points of the wall are asked; two must be seen through. */
ale_visibility_t ale_wall_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from);

/* The same of the point t_um along the wall's tangent alone. */
ale_visibility_t ale_wall_point_visibility(const ale_wall_t *wall, int64_t t_um,
                                           const ale_posed_scan_t *from);

#endif
