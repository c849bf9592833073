#include "track/map_corner.h"

#include "base/fixed.h"
#include "base/trig.h"

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
}

/* The corner in the map's frame; the covariance turned from the sensor's frame: R C R^T. */
static ale_map_corner_t in_map(const ale_corner_t *c, ale_pose_t sensor)
{
    const int64_t cos_q15 = ale_round_shift(ale_cos_q30(sensor.theta_bam), 15);
    const int64_t sin_q15 = ale_round_shift(ale_sin_q30(sensor.theta_bam), 15);
    const int64_t cc = cos_q15 * cos_q15;
    const int64_t ss = sin_q15 * sin_q15;
    const int64_t cs = cos_q15 * sin_q15;
    const int64_t *v = c->cov_um2;
    ale_map_corner_t m = {.p = ale_pose_apply(sensor, c->p),
                          .angle_bam = c->angle_bam,
                          .bisector_bam = c->bisector_bam + sensor.theta_bam,
                          .seen = 1,
                          .kind = c->kind};
    m.cov_um2[0] =
        ale_mul_shift(cc, v[0], 30) - 2 * ale_mul_shift(cs, v[1], 30) + ale_mul_shift(ss, v[2], 30);
    m.cov_um2[1] = ale_mul_shift(cs, v[0] - v[2], 30) + ale_mul_shift(cc - ss, v[1], 30);
    m.cov_um2[2] =
        ale_mul_shift(ss, v[0], 30) + 2 * ale_mul_shift(cs, v[1], 30) + ale_mul_shift(cc, v[2], 30);
    return m;
}

static int32_t nearest(const ale_map_corners_t *corners, const ale_map_corner_t *c)
{
    int32_t best = NO_CORNER;
    int64_t least = REACH_UM;
    for (int32_t i = 0; i < corners->count; i++) {
        const ale_map_corner_t *m = &corners->corner[i];
        const int64_t far_um =
            ale_max64(ale_abs64((int64_t)m->p.x_um - c->p.x_um), ale_abs64((int64_t)m->p.y_um - c->p.y_um));
        if (far_um < least && m->kind == c->kind &&
            ale_abs64(ale_bam_diff(m->bisector_bam, c->bisector_bam)) < BISECTOR_BAM) {
            least = far_um;
            best = i;
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

static void add(ale_map_corners_t *corners, const ale_map_corner_t *c, uint32_t scan)
{
    int32_t place = corners->count < ALE_MAP_MAX_CORNERS ? corners->count : NO_CORNER;
    for (int32_t i = 0; place == NO_CORNER && i < ALE_MAP_MAX_CORNERS; i++) {
        place = corners->corner[i].seen == 1 ? i : NO_CORNER;
    }
    if (place == NO_CORNER) {
        corners->refused++;
        return;
    }
    corners->count = (uint16_t)ale_max64(corners->count, place + 1);
    corners->corner[place] = *c;
    corners->born[place] = scan;
}

uint16_t ale_map_corners_update(ale_map_corners_t *corners, const ale_features_t *features, ale_pose_t sensor,
                                uint32_t scan, bool grow)
{
    uint16_t known = 0;
    for (uint32_t i = 0; i < features->corner_count && i < ALE_CORNERS_PER_SCAN; i++) {
        const ale_map_corner_t c = in_map(&features->corner[i], sensor);
        const int32_t found = nearest(corners, &c);
        if (found != NO_CORNER) {
            observe(&corners->corner[found], &c);
            known++;
        } else if (grow) {
            add(corners, &c, scan);
        }
    }
    return known;
}
