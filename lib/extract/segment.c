#include "extract/segment.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    NOISE_FACTOR = 7,  /* deviations of one beam's own error: 5 of the difference of two */
    SHARED_FACTOR = 5, /* the same of the constant part of the shared error */
    UNRULY_PERCENT = 45,
    BLOCK = 8,         /* points looked at without asking for the end of the loop */
    SUSPECT_HALVES = 7 /* half deviations that a suspicious change exceeds: less than a spike or a jump has */
};

typedef struct {
    int64_t constant_um;
    int64_t noise_q20;     /* part of the range that the noise may make */
    int64_t incidence_q20; /* part of the range that one beam advances at 45 degrees of incidence */
} jump_limit_t;

/*@ assigns \nothing; */
static jump_limit_t jump_limit(const ale_scan_noise_t *noise, int64_t step_nrad)
{
    const int64_t shared_um = ((int64_t)ale_isqrt((uint64_t)noise->shared_mm2_q36) * 1000) >> 18;
    const jump_limit_t limit = {
        .constant_um = NOISE_FACTOR * noise->sigma_um + SHARED_FACTOR * shared_um,
        .noise_q20 = NOISE_FACTOR * noise->sigma_per_range_q20,
        .incidence_q20 = step_nrad * (1 << 20) / 1000000000,
    };
    return limit;
}

/* Change of range a beam, from point i to the next; 0 beyond the ends. */
static inline int64_t slope_um(const ale_points_t *p, int32_t i)
{
    if (i < 0 || i + 1 >= p->count) {
        return 0;
    }
    const int32_t change_um = p->range_um[i + 1] - p->range_um[i];
    const int32_t gap = ale_beams_between(p->beam, i, i + 1);
    //@ assert gap >= 1;
    return (change_um < 0 ? -change_um : change_um) / gap;
}

/* From point i over `gap` beams to the next point. A change of range that noise and 45 degrees of incidence
 * do not explain is a jump, unless both neighbouring changes show that the surface is steeper than that; so
 * is a wide gap. */
/*@ assigns \nothing; */
static inline bool is_jump(const ale_points_t *p, const jump_limit_t *limit, int32_t i, int32_t next,
                           int64_t gap)
{
    const int64_t change_um = ale_abs64((int64_t)p->range_um[next] - p->range_um[i]);
    const int64_t range_um = ale_min64(p->range_um[i], p->range_um[next]);
    const int64_t allowed_um =
        limit->constant_um + (range_um * (limit->noise_q20 + gap * limit->incidence_q20) >> 20);
    if (change_um <= allowed_um) {
        return gap > ALE_MAX_GAP_BEAMS;
    }
    const int64_t beyond_um = (change_um - allowed_um) * 2;
    return gap > ALE_MAX_GAP_BEAMS || beyond_um > 3 * gap * slope_um(p, i - 1) ||
           beyond_um > 3 * gap * slope_um(p, next);
}

/*@ assigns \nothing; */
static bool is_jump_at_seam(const ale_points_t *p, const jump_limit_t *limit)
{
    const int32_t last = p->count - 1;
    return p->turn_beams == 0 || is_jump(p, limit, last, 0, p->beam[0] + p->turn_beams - p->beam[last]);
}

/* After which point the range changes: never the last one. */
/*@ assigns \nothing;
  @ ensures 0 <= \result < ALE_MAX_BEAMS - 1; */
static inline int32_t suspect_of(const ale_segments_t *s, int32_t k)
{
    return s->suspect[k];
}

/*@ requires s->count < ALE_MAX_BEAMS;
  @ assigns s->count, s->segment[s->count];
  @ ensures s->count == \old(s->count) + 1; */
static void end_segment(ale_segments_t *s, int32_t first, int32_t last)
{
    s->segment[s->count].first = (uint16_t)first;
    s->segment[s->count].last = (uint16_t)last;
    s->count++;
}

/* A change is suspicious when it is more than a constant and a part of the sum of both ranges: then the
 * larger one less its part is more than the other with its own. */
typedef struct {
    int64_t constant_q20;
    int64_t less_q20;
    int64_t more_q20;
} suspicion_t;

/* A range less its part, and with it and the constant. */
typedef struct {
    int64_t less_q20;
    int64_t more_q20;
} bounds_t;

/*@ assigns \nothing; */
static inline bounds_t bounds_of(const suspicion_t *of, int64_t range_um)
{
    return (bounds_t){range_um * of->less_q20, range_um * of->more_q20 + of->constant_q20};
}

/* Adds point i where it is suspicious. *here: bounds of its range, then those of the next one. */
/*@ requires 0 <= i < ALE_MAX_BEAMS - 1 && s->suspect_count <= i;
  @ requires \separated(s, points, here, of);
  @ assigns *here, s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1];
  @ ensures s->suspect_count <= i + 1; */
static inline void look_at(ale_segments_t *s, const ale_points_t *points, const suspicion_t *of, int32_t i,
                           bounds_t *here)
{
    const bounds_t next = bounds_of(of, points->range_um[i + 1]);
    if (next.less_q20 > here->more_q20 || here->less_q20 > next.more_q20) {
        s->suspect[s->suspect_count++] = (uint16_t)i;
    }
    *here = next;
}

/* Adds the suspects among first..last - 1. */
/*@ requires 0 <= first < ALE_MAX_BEAMS && last < ALE_MAX_BEAMS && s->suspect_count <= first;
  @ requires \separated(s, points);
  @ assigns s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1];
  @ ensures s->suspect_count <= (first < last ? last : first); */
static void add_suspects(ale_segments_t *s, const ale_points_t *points, const ale_scan_noise_t *noise,
                         int32_t first, int32_t last)
{
    const int64_t per_sum_q20 = SUSPECT_HALVES * noise->sigma_per_range_q20 / 4;
    const suspicion_t of = {SUSPECT_HALVES * (noise->sigma_um << 20) / 2, (1 << 20) - per_sum_q20,
                            (1 << 20) + per_sum_q20};
    bounds_t here = bounds_of(&of, points->range_um[first]);
    int32_t i = first;
    /*@ loop invariant first <= i && s->suspect_count <= i && (i == first || i <= last);
      @ loop assigns i, here, s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1]; */
    for (; i + BLOCK <= last; i += BLOCK) {
        /*@ loop invariant 0 <= j <= BLOCK && s->suspect_count <= i + j;
          @ loop assigns j, here, s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1]; */
        for (int32_t j = 0; j < BLOCK; j++) {
            look_at(s, points, &of, i + j, &here);
        }
    }
    /*@ loop invariant first <= i && s->suspect_count <= i && (i == first || i <= last);
      @ loop assigns i, here, s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1]; */
    for (; i < last; i++) {
        look_at(s, points, &of, i, &here);
    }
}

/* In a sparse scan the points lie farther apart: each stands for the beams to the next one. */
/*@ assigns \nothing; */
static int32_t beams_looked_at(const ale_points_t *points)
{
    return points->sparse && points->count > 0 ? points->beam[points->count - 1] + 1 - points->beam[0]
                                               : points->count;
}

void ale_segment_suspect(ale_segments_t *s, const ale_points_t *points, const ale_scan_noise_t *noise)
{
    const int32_t count = points->count;
    int32_t first = 0;
    s->suspect_count = 0;
    /*@ loop invariant 0 <= first < ALE_MAX_BEAMS && s->suspect_count <= first;
      @ loop assigns k, first, s->suspect_count, s->suspect[0 .. ALE_MAX_BEAMS - 1]; */
    for (int32_t k = 0; k < points->gap_count; k++) {
        const int32_t last = (int32_t)ale_max64(points->gap_after[k], first);
        if (last + 1 >= count) {
            break;
        }
        add_suspects(s, points, noise, first, last);
        s->suspect[s->suspect_count++] = (uint16_t)last;
        first = last + 1;
    }
    add_suspects(s, points, noise, first, count - 1);
    s->unruly = s->suspect_count * 100 > beams_looked_at(points) * UNRULY_PERCENT;
}

/*@ requires points <= ALE_MAX_BEAMS;
  @ assigns s->jump_after[0 .. ALE_MAX_BEAMS - 1]; */
static void forget_jumps(ale_segments_t *s, uint32_t points)
{
    memset(s->jump_after, 0, points * sizeof *s->jump_after);
}

void ale_segment_cut(ale_segments_t *s, const ale_points_t *points, const ale_scan_noise_t *noise)
{
    s->count = 0;
    if (points->count == 0) {
        return;
    }
    const jump_limit_t limit = jump_limit(noise, points->step_nrad);
    int32_t first = 0;
    const int32_t suspects = s->suspect_count;
    forget_jumps(s, points->count);
    /*@ loop invariant 0 <= k <= suspects && s->count <= k && 0 <= first;
      @ loop assigns k, first, s->count, s->segment[0 .. ALE_MAX_BEAMS - 1],
      @     s->jump_after[0 .. ALE_MAX_BEAMS - 1]; */
    for (int32_t k = 0; k < suspects; k++) {
        const int32_t i = suspect_of(s, k);
        if (is_jump(points, &limit, i, i + 1, points->beam[i + 1] - points->beam[i])) {
            s->jump_after[i] = true;
            end_segment(s, first, i);
            first = i + 1;
        }
    }
    s->jump_after[points->count - 1] = true;
    s->jump_at_seam = is_jump_at_seam(points, &limit);
    end_segment(s, first, points->count - 1);
}
