#include "track/step_search.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "track/maps.h"
#include "track/step_associate.h"
#include "track/step_observe.h"
#include "track/step_recover.h"

enum {
    WHOLE_MAP_UM = 2000000000, /* a reach beyond any map */
    SAID_SIGMA_UM = 100000,
    SAID_SIGMA_URAD = 50000,
    LOOK_UM = 1000000,    /* a robot that has gone on, or turned, by so much sees something else */
    EXPECTED_UM = 500000, /* of where the prediction has put the robot: there less will do */
    EXPECTED_BAM = 350 * ALE_BAM_PER_MRAD,
    EXPECTED_LEAST_UM = 2000000,
    LAID_LEAST_UM = 20000000,   /* of walls of the one map that lie on the other; */
    LAID_LOADED_UM = 15000000,  /* so much on one that was loaded; */
    LAID_SMALL_UM = 10000000,   /* so much where the maps are small */
    DENIED_WEIGHT = 10,         /* one that the way there has led through speaks against so many */
    LAID_WALL_MOST_UM = 2000000 /* that one of them counts for */
};

static const ale_gate_t laid_gate = {100000, 100000, 1000, 0};

/* Where a scan searches. */
typedef enum { ANYWHERE, NEAR, WHERE_SAID } search_t;

/* What is claimed is tried with every other scan, for a while; what somebody has said in turns with what is
 * around it. Later a look around is worth it where the robot has gone on: its own map leads it. */
static search_t next_search(ale_pipeline_t *p, ale_pose_t displacement)
{
    p->claims = (uint16_t)(p->claims > 0 ? p->claims - 1 : 0);
    p->unlooked_um += ale_abs64(displacement.x_um) + ale_abs64(displacement.y_um) +
                      ale_abs64(ale_bam_to_nrad((int32_t)displacement.theta_bam)) / 1000;
    const bool due = p->claims > 0 ? p->claims % 2 != 0 : p->unlooked_um > LOOK_UM;
    if (p->claim == ALE_CLAIM_NONE || !due) {
        return ANYWHERE;
    }
    p->unlooked_um = 0;
    return p->claim == ALE_CLAIM_SAID && p->claims % 4 == 3 ? WHERE_SAID : NEAR;
}

/* What the robot has looked through on the way through its own map, if it is at this pose of the selected
 * one. */
static int64_t denied_um(ale_pipeline_t *p, ale_pose_t there)
{
    const ale_pose_t smooth = ale_pose_compose(p->smooth.shift, p->motion.pose);
    return ale_way_back_denied_um(&p->way_back, &p->map, smooth, there);
}

/* Surfaces that a map holds, of each wall so much as it counts for. */
static int64_t held_um(const ale_local_map_t *map, uint8_t number)
{
    int64_t sum_um = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        const ale_wall_t *wall = &map->wall[i];
        const int64_t length_um = (int64_t)wall->end_um - wall->start_um;
        sum_um += wall->map == number ? ale_min64(length_um, LAID_WALL_MOST_UM) : 0;
    }
    return sum_um;
}

/* How much of the robot's own map must lie on the selected one. A loaded map may hold all that there is; what
 * this drive has not seen may look like what it has, and the more the longer it goes on. */
static int64_t least_um(const ale_pipeline_t *p, bool expected)
{
    if (expected) {
        return EXPECTED_LEAST_UM;
    }
    const int64_t there_um = held_um(&p->map, p->map.selected);
    if (p->loaded != 0) {
        return ale_clamp64(there_um / 2, LAID_SMALL_UM, LAID_LOADED_UM);
    }
    const int64_t larger_um = ale_max64(there_um, held_um(&p->map, p->atlas.current));
    return ale_clamp64(larger_um / 4 * 3, LAID_SMALL_UM, LAID_LEAST_UM);
}

/* How much of the robot's own map lies on the selected one, when the robot is at this pose of that. Each wall
 * counts once: many scans from one place show no more than one does. The newest are asked first: work is
 * bounded. */
static int64_t laid_um(const ale_pipeline_t *p, ale_pose_t there)
{
    const ale_viewpoint_t shift = ale_viewpoint(ale_pose_shift(p->motion.pose, there));
    int32_t work = ALE_ASSOCIATION_WORK;
    int64_t explained_um = 0;
    for (uint32_t i = p->map.count; i > 0; i--) {
        const ale_wall_t *wall = &p->map.wall[i - 1];
        if (wall->map == p->atlas.current && wall->seen >= ALE_MAP_CONFIRMED) {
            const ale_observation_t as_seen = {.centre = wall->anchor,
                                               .normal_bam = wall->normal_bam,
                                               .start_um = wall->start_um,
                                               .end_um = wall->end_um,
                                               .var_offset_um2 = wall->var_offset_um2,
                                               .var_angle_urad2 = wall->var_angle_urad2};
            const ale_association_t a = ale_associate(&p->map, &as_seen, &shift, NULL, &laid_gate, &work);
            const int64_t length_um = ale_min64(ale_observation_length_um(&as_seen), LAID_WALL_MOST_UM);
            explained_um += a.wall == ALE_NO_WALL ? 0 : ale_min64(a.error.overlap_um, length_um);
        }
    }
    return explained_um;
}

/* By how much more lies there than must; 0 or less: not enough, or not where wheels have led. */
static int64_t surplus_um(const ale_pipeline_t *p, ale_pose_t there)
{
    /* in a loaded map a drive may begin where the one before has begun */
    const bool told = p->loaded != 0 || (p->claim != ALE_CLAIM_NONE && p->claim != ALE_CLAIM_REACHED);
    const bool expected = told && ale_are_near(p->motion.pose, there, EXPECTED_UM, EXPECTED_BAM);
    if (p->claim == ALE_CLAIM_DRIVEN && !expected) {
        return 0;
    }
    return laid_um(p, there) - least_um(p, expected);
}

static void fit_at(ale_pipeline_t *p, ale_pose_t pose, ale_fit_t *fit)
{
    ale_motion_t there = p->motion;
    there.pose = pose;
    ale_motion_widen(&there, SAID_SIGMA_UM, SAID_SIGMA_URAD);
    ale_pipeline_fit(p, &there, WHOLE_MAP_UM, fit);
}

/* Near where the robot was last known to be. */
static bool is_near(ale_pipeline_t *p, ale_fit_t *fit)
{
    if (!ale_recover_in_region(p, p->motion.pose)) {
        return false;
    }
    *fit = p->best;
    return true;
}

static bool is_anywhere(ale_pipeline_t *p, ale_fit_t *fit)
{
    const ale_point_t anywhere = {0, 0};
    ale_local_map_approach(&p->map, anywhere, WHOLE_MAP_UM);
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_posed_scan_t mounted = {&p->observed.scan, ale_observed_bearings(&p->observed),
                                      p->config.sensor};
    return ale_relocate(&p->relocation, &scene, &mounted, &p->motion, fit) && ale_tracking_accepts(fit);
}

/* Whether the robot is where it is said to be, or where the last scan has recognised a place; else the place
 * is searched, and what is found waits for the next scan. */
static bool is_found(ale_pipeline_t *p, search_t search, ale_fit_t *fit)
{
    ale_pose_t at;
    const bool recognised = ale_relocation_recognised(&p->relocation, &at);
    if (search == ANYWHERE && !recognised && p->partial) {
        return false; /* what is not in work may look alike */
    }
    p->searched = true;
    if (recognised) {
        fit_at(p, at, fit);
        return ale_tracking_explains(fit) && p->surplus_um > DENIED_WEIGHT * denied_um(p, fit->motion.pose);
    }
    if (search == WHERE_SAID) {
        fit_at(p, p->motion.pose, fit);
        return ale_tracking_confirms(fit);
    }
    if (search == NEAR ? is_near(p, fit) : is_anywhere(p, fit)) {
        p->surplus_um = surplus_um(p, fit->motion.pose);
        if (p->surplus_um > 0) {
            ale_relocation_recognise(&p->relocation, fit->motion.pose);
        }
    }
    return false;
}

void ale_step_search(ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const ale_pose_t displacement = ale_pose_between(prediction->before.pose, p->motion.pose);
    const bool followed = p->monitor.state != ALE_STATE_LOST && !p->monitor.contradicted;
    ale_relocation_follow(&p->relocation, displacement, followed || prediction->ways.counted);
    if (p->tile_waits) {
        return; /* for this scan, and the search for the next */
    }
    const search_t search = next_search(p, displacement);
    if (p->searched) {
        return; /* in the robot's own map: that is enough for a scan */
    }
    ale_local_map_select(&p->map, ALE_FIRST_MAP);
    const bool found = is_found(p, search, &p->other);
    ale_local_map_select(&p->map, p->atlas.current);
    if (found) {
        ale_maps_join(p, ALE_FIRST_MAP, &p->other);
        p->fit = p->other;
    }
}
