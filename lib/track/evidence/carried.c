#include "track/evidence/carried.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/wall.h"

enum {
    SAME_UM = 60000, /* how far it may move to and fro before the robot, and per mille of the range */
    SAME_PER_MILLE = 50,
    ASIDE_UM = 60000,   /* neighbours that differ by less may show the same thing, */
    GAP_BEAMS = 3,      /* if fewer between them have no value or show what was there before */
    VIOLATED_LEAST = 2, /* points of an observation that were looked through */
    SHORTER_UM = 120000,
    LEAST_PART = 8,         /* of the beams: less does no harm */
    EXPLAINED_PERCENT = 60, /* of what else is shown is in the map: it is not the robot that was carried */
    NEAR_UM = 200000,       /* from elsewhere, */
    NEAR_BAM = 15 * ALE_BAM_PER_DEGREE,
    SOON_US = 300000, /* or later, a room looks otherwise */
    TO_AND_FRO_US = 10000000
};

void ale_carried_clear(ale_carried_t *carried)
{
    carried->any = false;
}

static bool is_same(int32_t a_um, int32_t b_um)
{
    return ale_abs64((int64_t)a_um - b_um) <= SAME_UM + (int64_t)b_um * SAME_PER_MILLE / 1000;
}

static void mask_beam(ale_carried_t *carried, ale_scan_t *scan, int32_t k)
{
    if (carried->came_um[k] <= 0) {
        carried->came_um[k] = 0;
    } else if (scan->flag[k] == ALE_BEAM_VALID && is_same(scan->range_um[k], carried->came_um[k])) {
        carried->last_um[k] = scan->range_um[k];
        scan->range_um[k] = 0;
        scan->flag[k] = ALE_BEAM_BLIND;
    } else if (scan->flag[k] == ALE_BEAM_VALID) {
        carried->came_um[k] = -1;
    }
}

void ale_carried_mask(ale_carried_t *carried, ale_scan_t *scan)
{
    if (!carried->any) {
        return;
    }
    carried->any = false;
    for (int32_t k = 0; carried->beams == scan->beams && k < scan->beams; k++) {
        mask_beam(carried, scan, k);
        carried->any = carried->any || carried->came_um[k] != 0;
    }
}

void ale_carried_show(const ale_carried_t *carried, ale_scan_t *scan)
{
    for (int32_t k = 0; carried->any && k < scan->beams; k++) {
        if (carried->came_um[k] > 0 && scan->flag[k] == ALE_BEAM_BLIND) {
            scan->range_um[k] = carried->last_um[k];
            scan->flag[k] = ALE_BEAM_VALID;
        }
    }
}

/* What has come in a scan, before it is known to be enough. */
typedef struct {
    uint64_t beam[(ALE_MAX_BEAMS + 63) / 64]; /* a bit for each */
    const ale_scan_t *before;
    const ale_scan_t *now;
    int32_t turned;  /* beams that the robot has turned since before */
    int32_t shorter; /* of its beams, those that went farther then */
} come_t;

static bool has_come(const come_t *come, int32_t beam)
{
    return (come->beam[beam / 64] >> beam % 64 & 1U) != 0;
}

/* Whether a beam went farther before. */
static bool is_shorter(const come_t *come, int32_t beam)
{
    const int32_t then = beam + come->turned;
    return then >= 0 && then < come->before->beams && come->before->flag[then] == ALE_BEAM_VALID &&
           come->before->range_um[then] - come->now->range_um[beam] > SHORTER_UM;
}

/* Or met nothing. */
static bool was_free(const come_t *come, int32_t beam)
{
    const int32_t then = beam + come->turned;
    return is_shorter(come, beam) ||
           (then >= 0 && then < come->before->beams && come->before->flag[then] != ALE_BEAM_VALID);
}

static void add(come_t *come, int32_t beam)
{
    if (!has_come(come, beam)) {
        come->beam[beam / 64] |= (uint64_t)1 << beam % 64;
        come->shorter += is_shorter(come, beam);
    }
}

/* The beams beside one that show the same thing, in one direction. */
static void spread(come_t *come, int32_t from, int32_t step)
{
    const ale_scan_t *scan = come->now;
    int32_t last_um = scan->range_um[from];
    int32_t gap = 0;
    for (int32_t k = from + step; k >= 0 && k < scan->beams && gap < GAP_BEAMS; k += step) {
        if (scan->flag[k] != ALE_BEAM_VALID || !was_free(come, k)) {
            gap++;
            continue;
        }
        if (has_come(come, k) || ale_abs64((int64_t)scan->range_um[k] - last_um) > ASIDE_UM) {
            return;
        }
        last_um = scan->range_um[k];
        gap = 0;
        add(come, k);
    }
}

static void take_out(come_t *come, const ale_observation_t *observation)
{
    const int32_t beams = ale_observation_beams(observation, come->now);
    for (int32_t i = 0; i < beams; i++) {
        const int32_t k = (observation->first_beam + i) % come->now->beams;
        if (come->now->flag[k] == ALE_BEAM_VALID) {
            add(come, k);
        }
    }
    spread(come, observation->first_beam, -1);
    spread(come, observation->last_beam, 1);
}

static bool is_out(const come_t *come, const ale_observation_t *observation)
{
    return has_come(come, observation->first_beam) && has_come(come, observation->last_beam);
}

static bool is_matched(const ale_association_t *association)
{
    return association->wall != ALE_NO_WALL || association->landmark != ALE_NO_LANDMARK;
}

static bool was_looked_through(const ale_seen_t *before, const ale_viewpoint_t *viewpoint,
                               const ale_observation_t *observation)
{
    const ale_observation_t placed = ale_observation_from(observation, viewpoint);
    ale_wall_t surface;
    ale_wall_from_observation(&surface, &placed);
    const ale_points_visibility_t visibility =
        ale_wall_points_visibility(&surface, &before->posed, (ale_slack_t){0, 0, false});
    return visibility.supported == 0 && visibility.violated >= VIOLATED_LEAST;
}

/* Whether something came so lately that it may still move before the robot. */
static bool moves(const ale_carried_t *carried, const ale_scan_t *scan)
{
    return carried->any && scan->stamp_us - carried->came_us < TO_AND_FRO_US;
}

/* Whether most beams of an observation showed in the last scan what goes along. */
static bool moved_aside(const ale_carried_t *carried, const ale_observation_t *observation,
                        const ale_scan_t *scan)
{
    int32_t moved = 0;
    const int32_t beams = ale_observation_beams(observation, scan);
    for (int32_t i = 0; i < beams; i++) {
        moved += carried->came_um[(observation->first_beam + i) % scan->beams] < 0;
    }
    return 2 * moved > beams;
}

static void find(const ale_carried_t *carried, const ale_seen_t *before, const ale_seen_t *now,
                 const ale_association_t association[], come_t *come)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(now->robot);
    const bool to_and_fro = moves(carried, now->posed.scan);
    for (uint32_t i = 0; i < now->observation_count; i++) {
        const ale_observation_t *observation = &now->observation[i];
        if (!is_matched(&association[i]) && !is_out(come, observation) &&
            ((to_and_fro && moved_aside(carried, observation, now->posed.scan)) ||
             was_looked_through(before, &viewpoint, observation))) {
            take_out(come, observation);
        }
    }
}

/* Whether the map holds most of what the scan shows besides. */
static bool is_explained(const come_t *come, const ale_seen_t *now, const ale_association_t association[])
{
    int64_t shown_um = 0;
    int64_t matched_um = 0;
    for (uint32_t i = 0; i < now->observation_count; i++) {
        const int64_t length_um = ale_observation_length_um(&now->observation[i]);
        if (!is_out(come, &now->observation[i])) {
            shown_um += length_um;
            matched_um += is_matched(&association[i]) ? length_um : 0;
        }
    }
    return matched_um * 100 > shown_um * EXPLAINED_PERCENT;
}

static void note(ale_carried_t *carried, const come_t *come, bool much, ale_scan_t *scan)
{
    if (!carried->any) {
        memset(carried->came_um, 0, sizeof carried->came_um);
        carried->beams = scan->beams;
        carried->any = true;
    }
    carried->came_us = much ? scan->stamp_us : carried->came_us;
    for (int32_t k = 0; k < scan->beams; k++) {
        if (has_come(come, k)) {
            carried->came_um[k] = carried->last_um[k] = scan->range_um[k];
            scan->range_um[k] = 0;
            scan->flag[k] = ALE_BEAM_BLIND;
        }
    }
}

static uint32_t without(const come_t *come, uint32_t count, ale_observation_t observation[],
                        ale_association_t association[])
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_out(come, &observation[i])) {
            observation[left] = observation[i];
            association[left++] = association[i];
        }
    }
    return left;
}

static bool is_comparable(const ale_seen_t *before, const ale_seen_t *now)
{
    return before->posed.scan->beams == now->posed.scan->beams && now->posed.scan->step_bam != 0 &&
           ale_abs64(now->posed.scan->stamp_us - before->posed.scan->stamp_us) < SOON_US &&
           ale_are_near(before->robot, now->robot, NEAR_UM, NEAR_BAM);
}

uint32_t ale_carried_notice(ale_carried_t *carried, const ale_seen_t *before, const ale_seen_t *now,
                            ale_scan_t *scan, ale_observation_t observation[],
                            ale_association_t association[])
{
    const uint32_t turned_bam = now->robot.theta_bam - before->robot.theta_bam;
    if (!is_comparable(before, now)) {
        return now->observation_count;
    }
    come_t come = {.before = before->posed.scan,
                   .now = now->posed.scan,
                   .turned = (int32_t)ale_round_div((int32_t)turned_bam, now->posed.scan->step_bam)};
    find(carried, before, now, association, &come);
    const bool much = come.shorter * LEAST_PART >= scan->beams;
    if ((!much && !moves(carried, scan)) || !is_explained(&come, now, association)) {
        return now->observation_count;
    }
    note(carried, &come, much, scan);
    return without(&come, now->observation_count, observation, association);
}
