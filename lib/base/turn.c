#include "base/turn.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    JOINED_BEAMS = ALE_MAX_BEAMS * 3 / 4, /* of joined points, which leaves room for those that do not join */
    SAME_UM = 30000, /* neighbours of one surface differ by less than this and a part of the range, */
    SAME_PER_MILLE = 10,
    SAME_SLOPE = 3,  /* and by what a surface of that slope (72 degrees) makes of the bearings between them */
    GAP_HALVES = 5,  /* half mean steps: a wider one says nothing of the step */
    LOST_HALVES = 3, /* from so many half steps on points are missing */
    MOST_LOST = UINT16_MAX, /* more than a scan holds */
    MOST_JOINED = 1 << 28,  /* so that three times as many, of any step, fit int64 */
    STEP_ROUNDS = 2
};

void ale_turn_begin(ale_turn_t *turn)
{
    turn->count = 0;
    turn->first_us = 0;
    turn->last_us = 0;
    turn->left_out = 0;
}

void ale_turn_add(ale_turn_t *turn, uint32_t bearing_bam, int32_t range_um, ale_beam_flag_t flag)
{
    if (turn->count < ALE_MAX_TURN_POINTS) {
        turn->point[turn->count] = (ale_turn_point_t){bearing_bam, range_um, (uint8_t)flag};
    }
    turn->count++;
}

/* What the points are made a scan by. */
typedef struct {
    const ale_turn_point_t *point;
    int32_t count;
    uint32_t origin_bam; /* bearing of the first point measured */
    bool clockwise;
    int64_t step_bam; /* from point to point, without sign */
    int32_t joined;   /* points that make a beam */
    bool one_each;    /* and no more beams than that */
} turned_t;

/* How far the mirror had turned since the first point. */
/*@ assigns \nothing; */
static uint32_t turned_by(const turned_t *t, uint32_t bearing_bam)
{
    return t->clockwise ? t->origin_bam - bearing_bam : bearing_bam - t->origin_bam;
}

/*@ requires turn->count <= ALE_MAX_TURN_POINTS;
  @ assigns \nothing; */
static bool is_clockwise(const ale_turn_t *turn)
{
    int32_t steps_back = 0;
    /*@ loop invariant 1 <= k <= ALE_MAX_TURN_POINTS + 1 && -k < steps_back && steps_back < k;
      @ loop assigns k, steps_back; */
    for (uint32_t k = 1; k < turn->count; k++) {
        const int32_t step_bam = ale_bam_diff(turn->point[k].bearing_bam, turn->point[k - 1].bearing_bam);
        steps_back += (step_bam < 0) - (step_bam > 0);
    }
    return steps_back > 0;
}

static bool are_sorted(const turned_t *t)
{
    int32_t k = 1;
    while (k < t->count &&
           turned_by(t, t->point[k - 1].bearing_bam) <= turned_by(t, t->point[k].bearing_bam)) {
        k++;
    }
    return k == t->count;
}

/* Merges the sorted points from..middle-1 and middle..end-1. */
static void merge(const turned_t *t, int32_t from, int32_t middle, int32_t end, ale_turn_point_t *out)
{
    int32_t a = from;
    int32_t b = middle;
    for (int32_t k = from; k < end; k++) {
        if (a < middle &&
            (b >= end || turned_by(t, t->point[a].bearing_bam) <= turned_by(t, t->point[b].bearing_bam))) {
            out[k] = t->point[a++];
        } else if (b < end) {
            out[k] = t->point[b++];
        }
    }
}

/* A device sends its points nearly sorted: most turns are. */
static void sort(ale_turn_t *turn, const turned_t *t)
{
    for (int32_t width = 1; width < t->count && !are_sorted(t); width *= 2) {
        for (int32_t from = 0; from < t->count; from += 2 * width) {
            const int32_t middle = (int32_t)ale_min64(from + width, t->count);
            merge(t, from, middle, (int32_t)ale_min64(from + 2 * width, t->count), turn->sorted);
        }
        memcpy(turn->point, turn->sorted, (size_t)t->count * sizeof *turn->point);
    }
}

/* From point k to the next. */
/*@ assigns \nothing;
  @ ensures -4294967296 < \result < 4294967296; */
static int64_t gap_bam(const turned_t *t, int32_t k)
{
    return (int64_t)turned_by(t, t->point[k + 1].bearing_bam) - turned_by(t, t->point[k].bearing_bam);
}

/* The mean step where no points are missing. */
/*@ requires t->count <= ALE_MAX_TURN_POINTS; */
static int64_t step_of(const turned_t *t)
{
    int64_t step_bam = (int64_t)turned_by(t, t->point[t->count - 1].bearing_bam) / (t->count - 1);
    //@ loop assigns round, step_bam;
    for (int32_t round = 0; round < STEP_ROUNDS; round++) {
        int64_t sum_bam = 0;
        int32_t steps = 0;
        /*@ loop invariant 0 <= k <= ALE_MAX_TURN_POINTS && 0 <= steps <= k;
          @ loop invariant -(k * 4294967296) <= sum_bam <= k * 4294967296;
          @ loop assigns k, steps, sum_bam; */
        for (int32_t k = 0; k + 1 < t->count; k++) {
            const int64_t gap = gap_bam(t, k);
            if (2 * gap <= GAP_HALVES * step_bam) {
                sum_bam += gap;
                steps++;
            }
        }
        step_bam = steps > 0 && sum_bam >= steps ? ale_min64(sum_bam / steps, UINT32_MAX) : step_bam;
    }
    return step_bam;
}

static bool are_of_one_surface(const turned_t *t, int32_t k)
{
    const ale_turn_point_t *a = &t->point[k];
    const ale_turn_point_t *b = &t->point[k + 1];
    if (a->flag != ALE_BEAM_VALID || b->flag != ALE_BEAM_VALID) {
        return a->flag == b->flag;
    }
    const int64_t range_um = ale_min64(a->range_um, b->range_um);
    const int64_t slope_um = gap_bam(t, k) * range_um / ALE_BAM_PER_RAD * SAME_SLOPE;
    return ale_abs64((int64_t)a->range_um - b->range_um) <=
           SAME_UM + range_um / 1000 * SAME_PER_MILLE + slope_um;
}

/* The last of the points from `first` on that are to make a beam, if they lie on one surface. */
static int32_t last_joined(const turned_t *t, int32_t first)
{
    int32_t last = first;
    while (last + 1 < t->count && last + 1 - first < t->joined &&
           2 * gap_bam(t, last) <= LOST_HALVES * t->step_bam * t->joined) {
        last++;
    }
    return last;
}

static int32_t last_of_surface(const turned_t *t, int32_t first, int32_t last)
{
    int32_t k = first;
    while (k < last && are_of_one_surface(t, k)) {
        k++;
    }
    return k;
}

/* Beams that are missing between a point and the next. */
static int32_t lost_after(const turned_t *t, int32_t k)
{
    const int64_t beams = k + 1 < t->count ? ale_round_div(gap_bam(t, k), t->joined * t->step_bam) : 1;
    return (int32_t)ale_clamp64(beams - 1, 0, MOST_LOST);
}

/* The parts were listed so that there is room: the bound stands here for whoever reads this alone. */
static void add_beam(ale_scan_t *scan, uint32_t bearing_bam, int32_t range_um, uint8_t flag)
{
    if (scan->beams >= ALE_MAX_BEAMS) {
        return;
    }
    const uint16_t k = scan->beams++;
    scan->bearing_bam[k] = bearing_bam;
    if (flag == ALE_BEAM_VALID) {
        ale_scan_set_range(scan, k, range_um);
        return;
    }
    scan->range_um[k] = 0;
    scan->code[k] = 0;
    scan->flag[k] = flag;
}

/* The mean of the points first..last. */
/*@ requires 0 <= first < ALE_MAX_TURN_POINTS && last < ALE_MAX_TURN_POINTS; */
static void add_joined(const turned_t *t, int32_t first, int32_t last, ale_scan_t *scan)
{
    const ale_turn_point_t *p = &t->point[first];
    int64_t range_um = 0;
    int64_t ahead_bam = 0;
    /*@ loop invariant first <= k;
      @ loop invariant -((k - first) * 2147483648) <= range_um <= (k - first) * 2147483648;
      @ loop invariant -((k - first) * 2147483648) <= ahead_bam <= (k - first) * 2147483648;
      @ loop assigns k, range_um, ahead_bam; */
    for (int32_t k = first; k <= last; k++) {
        range_um += t->point[k].range_um;
        ahead_bam += ale_bam_diff(t->point[k].bearing_bam, p->bearing_bam);
    }
    const int64_t n = ale_max64(last + 1 - first, 1);
    add_beam(scan, p->bearing_bam + (uint32_t)(uint64_t)ale_round_div(ahead_bam, n),
             (int32_t)ale_round_div(range_um, n), p->flag);
}

/* Beams without a value, evenly between two points. */
static void add_lost(const turned_t *t, int32_t from, int32_t to, int32_t lost, ale_scan_t *scan)
{
    const uint32_t from_bam = t->point[from].bearing_bam;
    const int64_t gap_bam = (int64_t)turned_by(t, t->point[to].bearing_bam) - turned_by(t, from_bam);
    for (int32_t i = 1; i <= lost; i++) {
        const uint32_t ahead_bam = (uint32_t)(gap_bam * i / (lost + 1));
        add_beam(scan, t->clockwise ? from_bam - ahead_bam : from_bam + ahead_bam, 0, ALE_BEAM_UNKNOWN);
    }
}

/* Whether the surface that begins at a point is nearer than that of another, or the only one with a range. */
static bool is_nearer(const turned_t *t, int32_t k, int32_t other)
{
    const ale_turn_point_t *a = &t->point[k];
    const ale_turn_point_t *b = &t->point[other];
    return a->flag == ALE_BEAM_VALID && (b->flag != ALE_BEAM_VALID || a->range_um < b->range_um);
}

/* There are as many parts as points at most. */
static void add_part(ale_turn_t *turn, int32_t first, int32_t last)
{
    if (turn->parts < ALE_MAX_TURN_POINTS) {
        turn->part[turn->parts++] = (ale_turn_part_t){(uint16_t)first, (uint16_t)last, 0};
    }
}

/* The group of points first..last: a part for each surface among them, or one for the nearest. */
static void list_group(const turned_t *t, int32_t first, int32_t last, ale_turn_t *turn)
{
    int32_t nearest = first;
    for (int32_t k = first; k <= last; k = last_of_surface(t, k, last) + 1) {
        nearest = is_nearer(t, k, nearest) ? k : nearest;
        if (!t->one_each) {
            add_part(turn, k, last_of_surface(t, k, last));
        }
    }
    if (t->one_each) {
        const int32_t end = last_of_surface(t, nearest, last);
        add_part(turn, nearest, end);
        turn->left_out += (uint32_t)(last - first - (end - nearest));
    }
}

/* Lists what makes a beam each; returns the number of beams. */
static int32_t list_parts(const turned_t *t, ale_turn_t *turn)
{
    int32_t lost = 0;
    turn->parts = 0;
    turn->left_out = 0;
    for (int32_t first = 0; first < t->count;) {
        const int32_t last = last_joined(t, first);
        list_group(t, first, last, turn);
        turn->part[ale_max64(turn->parts, 1) - 1].lost_after = (uint16_t)lost_after(t, last);
        lost = (int32_t)ale_min64(lost + lost_after(t, last), MOST_LOST);
        first = last + 1;
    }
    return turn->parts + lost;
}

/* Joins as many points as it takes for the scan to hold their beams. */
static void join(turned_t *t, ale_turn_t *turn)
{
    const int64_t places = turned_by(t, t->point[t->count - 1].bearing_bam) / t->step_bam + 1;
    const int64_t most = ale_max64(places, t->count);
    t->joined = most <= ALE_MAX_BEAMS ? 1 : (int32_t)((most + JOINED_BEAMS - 1) / JOINED_BEAMS);
    for (int32_t beams = list_parts(t, turn); beams > ALE_MAX_BEAMS && t->joined <= MOST_JOINED;
         beams = list_parts(t, turn)) {
        t->joined *= t->one_each || t->joined == 1 ? 2 : 1;
        t->one_each = true;
    }
}

/* Parts are made of points that are there. */
static int32_t point_of(const turned_t *t, uint16_t k)
{
    return (int32_t)ale_min64(k, t->count - 1);
}

static void write_beams(const turned_t *t, const ale_turn_t *turn, ale_scan_t *scan)
{
    scan->beams = 0;
    for (int32_t k = 0; k < turn->parts; k++) {
        const ale_turn_part_t *part = &turn->part[k];
        add_joined(t, point_of(t, part->first), point_of(t, part->last), scan);
        if (k + 1 < turn->parts && part->lost_after > 0) {
            add_lost(t, point_of(t, part->last), point_of(t, part[1].first), part->lost_after, scan);
        }
    }
}

static void set_geometry(const turned_t *t, const ale_turn_t *turn, uint32_t last_measured_bam,
                         ale_scan_t *scan)
{
    const int64_t last = ale_max64(scan->beams, 1) - 1;
    const int64_t first_bam = turned_by(t, scan->bearing_bam[0]);
    const int64_t swept_bam = (int64_t)turned_by(t, scan->bearing_bam[last]) - first_bam;
    const int64_t step_bam = ale_round_div(swept_bam, ale_max64(last, 1));
    /* the last point is the farthest, or by the jitter of bearings beyond a whole turn */
    const int64_t measured_bam = turned_by(t, last_measured_bam);
    const int64_t by_time_bam = ale_max64(2 * measured_bam < swept_bam ? swept_bam : measured_bam, 1);
    const int64_t sweep_us = ale_clamp64(turn->last_us - turn->first_us, -ALE_TURN_MOST_US, ALE_TURN_MOST_US);
    const int64_t middle = last / 2;
    const int64_t before_us = ale_mul_div(sweep_us, first_bam + middle * step_bam, by_time_bam);
    scan->own_bearings = true;
    scan->first_bearing_bam = scan->bearing_bam[0];
    scan->step_bam = (int32_t)(t->clockwise ? -step_bam : step_bam);
    scan->beam_time_ns =
        (int32_t)ale_clamp64(ale_mul_div(sweep_us * 1000, step_bam, by_time_bam), 0, INT32_MAX);
    scan->stamp_beam = (int32_t)middle;
    scan->stamp_us = turn->first_us + ale_clamp64(before_us, -ALE_TURN_MOST_US, ALE_TURN_MOST_US);
}

ale_turn_status_t ale_turn_to_scan(ale_turn_t *turn, ale_scan_t *scan)
{
    if (turn->count > ALE_MAX_TURN_POINTS) {
        return ALE_TURN_MANY;
    }
    if (turn->count < ALE_TURN_LEAST) {
        return ALE_TURN_FEW;
    }
    const uint32_t last_measured_bam = turn->point[turn->count - 1].bearing_bam;
    turned_t t = {.point = turn->point,
                  .count = (int32_t)turn->count,
                  .origin_bam = turn->point[0].bearing_bam,
                  .clockwise = is_clockwise(turn)};
    sort(turn, &t);
    t.step_bam = step_of(&t);
    if (t.step_bam <= 0) {
        return ALE_TURN_STILL;
    }
    join(&t, turn);
    write_beams(&t, turn, scan);
    set_geometry(&t, turn, last_measured_bam, scan);
    return ALE_TURN_FINE;
}

const char *ale_turn_status_text(ale_turn_status_t status)
{
    switch (status) {
    case ALE_TURN_FINE:
        return "fine";
    case ALE_TURN_FEW:
        return "fewer than 8 points a turn";
    case ALE_TURN_MANY:
        return "more than 4096 points a turn";
    case ALE_TURN_STILL:
        return "all points in one direction: the mirror does not turn";
    }
    return "unknown";
}
