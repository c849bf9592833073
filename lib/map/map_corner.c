#include "map/map_corner.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "observe/observation.h"

enum {
    REACH_UM = 100000,
    BISECTOR_BAM = 30 * ALE_BAM_PER_DEGREE,
    SEEN_MOST = 100, /* a corner stays open to change */
    NO_CORNER = -1
};

void ale_map_corners_clear(ale_map_corners_t *corners)
{
    corners->count = 0;
    corners->refused = 0;
    corners->selected = 0;
}

/* box NULL: none of the map is kept. */
void ale_map_corners_keep_within(ale_map_corners_t *corners, uint8_t map, const ale_box_t *box)
{
    uint16_t kept = 0;
    for (uint16_t i = 0; i < corners->count; i++) {
        if (corners->map[i] != map || (box && ale_box_has(box, corners->corner[i].p))) {
            corners->corner[kept] = corners->corner[i];
            corners->born[kept] = corners->born[i];
            corners->map[kept++] = corners->map[i];
        }
    }
    corners->count = kept;
}

void ale_map_corners_give_up(ale_map_corners_t *corners, uint8_t map)
{
    ale_map_corners_keep_within(corners, map, NULL);
}

/* The corner in the map's frame; the covariance turned from the sensor's frame: R C R^T. */
static ale_map_corner_t in_map(const ale_corner_t *c, const ale_viewpoint_t *sensor)
{
    const int64_t cos_q15 = ale_round_shift(sensor->turn.cos_q30, 15);
    const int64_t sin_q15 = ale_round_shift(sensor->turn.sin_q30, 15);
    const int64_t cc = cos_q15 * cos_q15;
    const int64_t ss = sin_q15 * sin_q15;
    const int64_t cs = cos_q15 * sin_q15;
    const int64_t *v = c->cov_um2;
    ale_map_corner_t m = {.p = ale_point_from(c->p, sensor),
                          .angle_bam = c->angle_bam,
                          .bisector_bam = c->bisector_bam + sensor->pose.theta_bam,
                          .seen = 1,
                          .kind = c->kind};
    m.cov_um2[0] =
        ale_mul_shift(cc, v[0], 30) - 2 * ale_mul_shift(cs, v[1], 30) + ale_mul_shift(ss, v[2], 30);
    m.cov_um2[1] = ale_mul_shift(cs, v[0] - v[2], 30) + ale_mul_shift(cc - ss, v[1], 30);
    m.cov_um2[2] =
        ale_mul_shift(ss, v[0], 30) + 2 * ale_mul_shift(cs, v[1], 30) + ale_mul_shift(cc, v[2], 30);
    return m;
}

static void grow_box(ale_point_t p, ale_point_t box[2])
{
    box[0].x_um = (int32_t)ale_min64(box[0].x_um, p.x_um);
    box[0].y_um = (int32_t)ale_min64(box[0].y_um, p.y_um);
    box[1].x_um = (int32_t)ale_max64(box[1].x_um, p.x_um);
    box[1].y_um = (int32_t)ale_max64(box[1].y_um, p.y_um);
}

/* The corners of the map that one of the scan's may be. */
static void list_around(ale_map_corners_t *corners, const ale_map_corner_t scan[], uint32_t count)
{
    ale_point_t box[2] = {scan[0].p, scan[0].p};
    corners->around_count = 0;
    for (uint32_t i = 1; i < count; i++) {
        grow_box(scan[i].p, box);
    }
    for (uint16_t i = 0; i < corners->count && corners->around_count < ALE_CORNERS_AROUND; i++) {
        const ale_point_t p = corners->corner[i].p;
        if (corners->map[i] == corners->selected && (int64_t)box[0].x_um - p.x_um < REACH_UM &&
            (int64_t)p.x_um - box[1].x_um < REACH_UM && (int64_t)box[0].y_um - p.y_um < REACH_UM &&
            (int64_t)p.y_um - box[1].y_um < REACH_UM) {
            corners->around[corners->around_count++] = i;
        }
    }
}

static int32_t nearest(const ale_map_corners_t *corners, const ale_map_corner_t *c)
{
    int32_t best = NO_CORNER;
    int64_t least = REACH_UM;
    for (int32_t i = 0; i < corners->around_count; i++) {
        const ale_map_corner_t *m = &corners->corner[corners->around[i]];
        const int64_t far_um =
            ale_max64(ale_abs64((int64_t)m->p.x_um - c->p.x_um), ale_abs64((int64_t)m->p.y_um - c->p.y_um));
        if (far_um < least && m->kind == c->kind &&
            ale_abs64(ale_bam_diff(m->bisector_bam, c->bisector_bam)) < BISECTOR_BAM) {
            least = far_um;
            best = corners->around[i];
        }
    }
    return best;
}

/* Running mean; the covariance falls with it. */
static void observe(ale_map_corner_t *m, const ale_map_corner_t *c)
{
    const int64_t n = ale_min64(m->seen, SEEN_MOST) + 1;
    m->p.x_um += (int32_t)ale_round_div((int64_t)c->p.x_um - m->p.x_um, n);
    m->p.y_um += (int32_t)ale_round_div((int64_t)c->p.y_um - m->p.y_um, n);
    m->bisector_bam += (uint32_t)(uint64_t)ale_round_div(ale_bam_diff(c->bisector_bam, m->bisector_bam), n);
    m->angle_bam += (uint32_t)(uint64_t)ale_round_div(ale_bam_diff(c->angle_bam, m->angle_bam), n);
    for (int i = 0; i < 3; i++) {
        m->cov_um2[i] += ale_round_div(c->cov_um2[i] / n - m->cov_um2[i], n);
    }
    m->seen++;
}

/* A place for a new corner: behind the last, or that of one that was seen once. Over all calls for one scan
 * the map is gone through once. */
static int32_t place_of_new(ale_map_corners_t *corners)
{
    if (corners->count < ALE_MAP_MAX_CORNERS) {
        return corners->count++;
    }
    while (corners->once < ALE_MAP_MAX_CORNERS && corners->corner[corners->once].seen > 1) {
        corners->once++;
    }
    return corners->once < ALE_MAP_MAX_CORNERS ? corners->once++ : NO_CORNER;
}

static void add(ale_map_corners_t *corners, const ale_map_corner_t *c, uint32_t scan)
{
    const int32_t place = place_of_new(corners);
    if (place == NO_CORNER) {
        corners->refused++;
        return;
    }
    corners->corner[place] = *c;
    corners->born[place] = scan;
    corners->map[place] = corners->selected;
    if (corners->around_count < ALE_CORNERS_AROUND) {
        corners->around[corners->around_count++] = (uint16_t)place;
    }
}

uint16_t ale_map_corners_update(ale_map_corners_t *corners, const ale_features_t *features, ale_pose_t sensor,
                                uint32_t scan, bool grow)
{
    ale_map_corner_t seen[ALE_CORNERS_PER_SCAN];
    const uint32_t count = (uint32_t)ale_min64(features->corner_count, ALE_CORNERS_PER_SCAN);
    uint16_t known = 0;
    if (count == 0) {
        return 0;
    }
    const ale_viewpoint_t viewpoint = ale_viewpoint(sensor);
    for (uint32_t i = 0; i < count; i++) {
        seen[i] = in_map(&features->corner[i], &viewpoint);
    }
    list_around(corners, seen, count);
    corners->once = 0;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t found = nearest(corners, &seen[i]);
        if (found != NO_CORNER) {
            observe(&corners->corner[found], &seen[i]);
            known++;
        } else if (grow) {
            add(corners, &seen[i], scan);
        }
    }
    return known;
}
