#include "motion/odometry.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    CLOCK_SET_BACK_US = 1000000,
    JUMP_FLOOR_MM = 50,
    JUMP_FLOOR_MRAD = 100,
    KNOWN_UM = 20000,
    KNOWN_MRAD = 20,
    EARLY = ALE_WHEELS_BEFORE + 16, /* samples that tell where the kept way begins, and how it is left ... */
    RECENT = 48                     /* ... and those that tell where the robot is now */
};

static const ale_odometry_t *sample_at(const ale_wheels_t *w, uint32_t index)
{
    return &w->sample[(w->first + index) % ALE_WHEELS_SAMPLES];
}

void ale_wheels_init(ale_wheels_t *wheels, int32_t max_speed_mm_s, int32_t max_turn_mrad_s)
{
    wheels->first = 0;
    wheels->count = 0;
    wheels->jumps = 0;
    wheels->kept_us = INT64_MAX;
    wheels->moved = false;
    wheels->max_speed_mm_s = max_speed_mm_s;
    wheels->max_turn_mrad_s = max_turn_mrad_s;
}

void ale_wheels_keep(ale_wheels_t *wheels, int64_t from_us)
{
    wheels->kept_us = from_us;
}

static int64_t usual_gap_us(const ale_wheels_t *w)
{
    const uint32_t from = w->count > RECENT ? w->count - RECENT : 0;
    const int64_t whole_us = sample_at(w, w->count - 1)->stamp_us - sample_at(w, from)->stamp_us;
    return w->count > 1 ? whole_us / (w->count - 1 - from) : 0;
}

/* Twice what the robot can do in the time between, or in what is usual when stamps crowd, and a little. */
static bool is_jump(const ale_wheels_t *w, const ale_odometry_t *before, const ale_odometry_t *now)
{
    const int64_t dt_us = ale_max64(now->stamp_us - before->stamp_us, usual_gap_us(w));
    const int64_t dt_ms = dt_us / 1000 + 1;
    const ale_pose_t d = ale_pose_between(before->pose, now->pose);
    const int64_t reach_um = 2 * dt_ms * w->max_speed_mm_s + (int64_t)JUMP_FLOOR_MM * 1000;
    const int64_t reach_mrad = 2 * dt_ms * w->max_turn_mrad_s / 1000 + JUMP_FLOOR_MRAD;
    const int64_t turn_mrad = ale_abs64((int32_t)d.theta_bam) / ALE_BAM_PER_MRAD;
    return ale_abs64(d.x_um) > reach_um || ale_abs64(d.y_um) > reach_um || turn_mrad > reach_mrad;
}

/* The pose a fraction num / den of the way from a to b; also beyond b. */
static ale_pose_t part_of_way(ale_pose_t a, ale_pose_t b, int64_t num, int64_t den)
{
    const int64_t turn_bam = ale_round_div((int64_t)ale_bam_diff(b.theta_bam, a.theta_bam) * num, den);
    /* Beyond samples whose stamps crowd it may lie farther than a pose holds: then it wraps. */
    const int64_t x_um = a.x_um + ale_round_div(((int64_t)b.x_um - a.x_um) * num, den);
    const int64_t y_um = a.y_um + ale_round_div(((int64_t)b.y_um - a.y_um) * num, den);
    return (ale_pose_t){(int32_t)(uint32_t)(uint64_t)x_um, (int32_t)(uint32_t)(uint64_t)y_um,
                        a.theta_bam + (uint32_t)(uint64_t)turn_bam};
}

/* The interval that holds an instant, or the last one: the sample at its end. Needs two samples. */
static uint32_t interval_at(const ale_wheels_t *w, int64_t t_us)
{
    uint32_t low = 1;
    uint32_t high = w->count - 1;
    while (low < high) {
        const uint32_t middle = (low + high + 1) / 2;
        if (sample_at(w, middle - 1)->stamp_us < t_us) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}

int64_t ale_wheels_gap_us(const ale_wheels_t *wheels, int64_t t_us)
{
    if (wheels->count < 2) {
        return 0;
    }
    const uint32_t k = interval_at(wheels, t_us);
    return sample_at(wheels, k)->stamp_us - sample_at(wheels, k - 1)->stamp_us;
}

bool ale_wheels_at(const ale_wheels_t *wheels, int64_t t_us, ale_pose_t *out, int32_t *beyond_us)
{
    *beyond_us = 0;
    if (wheels->count < 2 || t_us < sample_at(wheels, 0)->stamp_us) {
        return false;
    }
    const int64_t over_us = t_us - sample_at(wheels, wheels->count - 1)->stamp_us;
    if (over_us > ALE_WHEELS_EXTRAPOLATE_US) {
        return false;
    }
    if (over_us > 0) {
        *beyond_us = (int32_t)over_us;
    }
    const uint32_t k = interval_at(wheels, t_us);
    const ale_odometry_t *a = sample_at(wheels, k - 1);
    const ale_odometry_t *b = sample_at(wheels, k);
    *out = part_of_way(a->pose, b->pose, t_us - a->stamp_us, b->stamp_us - a->stamp_us);
    return true;
}

/* A sample that came late lies on the way that is known, as well as that can be interpolated. */
static bool is_on_known_way(const ale_wheels_t *w, const ale_odometry_t *sample)
{
    ale_pose_t known;
    int32_t beyond_us;
    if (!ale_wheels_at(w, sample->stamp_us, &known, &beyond_us)) {
        return false;
    }
    const ale_pose_t off = ale_pose_between(known, sample->pose);
    return ale_abs64(off.x_um) < KNOWN_UM && ale_abs64(off.y_um) < KNOWN_UM &&
           ale_abs64((int32_t)off.theta_bam) < (int64_t)KNOWN_MRAD * ALE_BAM_PER_MRAD;
}

static bool is_same_pose(ale_pose_t a, ale_pose_t b)
{
    return a.x_um == b.x_um && a.y_um == b.y_um && a.theta_bam == b.theta_bam;
}

/* Every other sample of the middle goes: between its ends a way is told by them alone. */
static void thin(ale_wheels_t *wheels)
{
    uint32_t kept = EARLY;
    for (uint32_t k = EARLY; k < wheels->count; k++) {
        if (k >= wheels->count - RECENT || (k - EARLY) % 2 == 0) {
            wheels->sample[(wheels->first + kept) % ALE_WHEELS_SAMPLES] = *sample_at(wheels, k);
            kept++;
        }
    }
    wheels->count = kept;
}

static void make_room(ale_wheels_t *wheels)
{
    if (sample_at(wheels, ALE_WHEELS_BEFORE)->stamp_us < wheels->kept_us) {
        wheels->first = (wheels->first + 1) % ALE_WHEELS_SAMPLES;
        wheels->count--;
    } else {
        thin(wheels);
    }
}

static void append(ale_wheels_t *wheels, const ale_odometry_t *sample)
{
    if (wheels->count == ALE_WHEELS_SAMPLES) {
        make_room(wheels);
    }
    wheels->sample[(wheels->first + wheels->count) % ALE_WHEELS_SAMPLES] = *sample;
    wheels->count++;
}

void ale_wheels_add(ale_wheels_t *wheels, const ale_odometry_t *sample)
{
    if (wheels->count == 0) {
        append(wheels, sample);
        return;
    }
    const ale_odometry_t *newest = sample_at(wheels, wheels->count - 1);
    const int64_t dt_us = sample->stamp_us - newest->stamp_us;
    wheels->moved = wheels->moved || !is_same_pose(newest->pose, sample->pose);
    const bool late = dt_us <= 0 && dt_us > -CLOCK_SET_BACK_US;
    const bool jump = dt_us > ALE_WHEELS_GAP_US || is_jump(wheels, newest, sample);
    if (late) {
        if (!jump && !is_on_known_way(wheels, sample)) {
            append(wheels, &(ale_odometry_t){newest->stamp_us + 1, sample->pose});
        }
        return;
    }
    if (dt_us < 0 || jump) {
        wheels->count = 0;
        wheels->jumps++;
    }
    append(wheels, sample);
}

bool ale_wheels_motion(const ale_wheels_t *wheels, int64_t from_us, int64_t to_us, ale_pose_t *out,
                       int32_t *beyond_us)
{
    ale_pose_t a;
    ale_pose_t b;
    int32_t ignored;
    if (!ale_wheels_at(wheels, from_us, &a, &ignored) || !ale_wheels_at(wheels, to_us, &b, beyond_us)) {
        return false;
    }
    *out = ale_pose_between(a, b);
    return true;
}

int64_t ale_wheels_way_um(const ale_wheels_t *wheels, int64_t from_us, int64_t to_us, int64_t *turned_urad)
{
    int64_t way_um = 0;
    *turned_urad = 0;
    for (uint32_t k = wheels->count; k > 1 && sample_at(wheels, k - 2)->stamp_us >= from_us; k--) {
        if (sample_at(wheels, k - 1)->stamp_us <= to_us) {
            const ale_pose_t d =
                ale_pose_between(sample_at(wheels, k - 2)->pose, sample_at(wheels, k - 1)->pose);
            way_um += ale_isqrt((uint64_t)((int64_t)d.x_um * d.x_um) + (uint64_t)((int64_t)d.y_um * d.y_um));
            *turned_urad += ale_abs64(ale_bam_to_nrad((int32_t)d.theta_bam)) / 1000;
        }
    }
    return way_um;
}

const ale_odometry_t *ale_wheels_sample_from(const ale_wheels_t *wheels, int64_t t_us)
{
    uint32_t k = wheels->count;
    while (k > 0 && sample_at(wheels, k - 1)->stamp_us >= t_us) {
        k--;
    }
    return k < wheels->count ? sample_at(wheels, k) : NULL;
}
