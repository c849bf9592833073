#include "track/evidence/slip.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    APART_SIGMAS = 3, /* of the wheels: nearer than that, least squares finds it from where they say */
    SLIP = 100000,    /* um and urad that wheels must be off, before they are said to slip */
    KNOWN_UM = 200000,
    KNOWN_URAD = 100000,
    WIDEN_MOST = 150000, /* um and urad together: gates that are wider still catch the wrong walls */
    APART_PARTS = 4      /* the rival is two sigmas off */
};

static int64_t turn_urad(ale_pose_t way)
{
    return ale_abs64(ale_bam_to_nrad((int32_t)way.theta_bam)) / 1000;
}

ale_apart_t ale_apart(ale_pose_t a, ale_pose_t b)
{
    const ale_pose_t way = ale_pose_between(a, b);
    return (ale_apart_t){ale_max64(ale_abs64(way.x_um), ale_abs64(way.y_um)), turn_urad(way)};
}

/* A radian counts as a metre. */
static int64_t distance(ale_pose_t a, const ale_motion_t *b)
{
    const ale_apart_t d = ale_apart(a, b->pose);
    return d.way_um + d.turn_urad;
}

bool ale_ways_rival_is_nearer(const ale_ways_t *ways, ale_pose_t pose)
{
    return distance(pose, &ways->rival) < distance(pose, &ways->believed);
}

static bool are_apart(const ale_motion_t *by_wheels, const ale_motion_t *as_before)
{
    const ale_pose_t way = ale_pose_between(by_wheels->pose, as_before->pose);
    return ale_abs64(way.x_um) > APART_SIGMAS * ale_matrix_sigma(&by_wheels->cov, 0) ||
           ale_abs64(way.y_um) > APART_SIGMAS * ale_matrix_sigma(&by_wheels->cov, 1) ||
           turn_urad(way) > APART_SIGMAS * ale_matrix_sigma(&by_wheels->cov, 2);
}

static bool is_known(const ale_motion_t *m)
{
    return ale_matrix_sigma(&m->cov, 0) < KNOWN_UM && ale_matrix_sigma(&m->cov, 1) < KNOWN_UM &&
           ale_matrix_sigma(&m->cov, 2) < KNOWN_URAD;
}

/* Least squares may find the robot at either tale, or on the line between them. */
static void widen(ale_motion_t *believed, const ale_motion_t *rival)
{
    const ale_pose_t way = ale_pose_between(believed->pose, rival->pose);
    int64_t apart[ALE_STATES] = {way.x_um, way.y_um, ale_bam_to_nrad((int32_t)way.theta_bam) / 1000};
    for (int i = 0; i < ALE_AXES; i++) {
        apart[i + ALE_AXES] = (int64_t)rival->velocity[i] - believed->velocity[i];
    }
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            believed->cov.m[i][j] += apart[i] * apart[j] / APART_PARTS;
        }
    }
}

ale_ways_t ale_ways_of(const ale_motion_t *by_wheels, const ale_motion_t *as_before, bool slips)
{
    ale_ways_t ways = {*by_wheels, *as_before, false, true};
    ways.part = is_known(as_before) && are_apart(by_wheels, as_before);
    if (ways.part && slips) {
        ale_ways_swap(&ways);
    } else if (ways.part && distance(as_before->pose, by_wheels) <= WIDEN_MOST) {
        widen(&ways.believed, &ways.rival);
    }
    return ways;
}

bool ale_ways_rival_is_known(const ale_ways_t *ways)
{
    return is_known(&ways->rival);
}

void ale_ways_swap(ale_ways_t *ways)
{
    const ale_motion_t rival = ways->rival;
    ways->rival = ways->believed;
    ways->believed = rival;
    ways->counted = !ways->counted;
}

bool ale_ways_slip(const ale_ways_t *ways, ale_pose_t found, bool slips)
{
    const int64_t wheels = distance(found, ways->counted ? &ways->believed : &ways->rival);
    const int64_t as_before = distance(found, ways->counted ? &ways->rival : &ways->believed);
    return slips ? as_before <= wheels : wheels > SLIP && 2 * as_before < wheels;
}
