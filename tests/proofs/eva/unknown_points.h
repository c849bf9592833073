/* Points of a scan, and its noise, of which nothing is known but what the headers of lib/extract say of the
 * fields. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_POINTS_H
#define ALE_PROOFS_EVA_UNKNOWN_POINTS_H

#include "extract/moments.h"
#include "unknown.h"

/* Beams from the first to the last one of a turn and over the seam; and of a turn that is read from behind
 * the widest gap. */
#define MOST_TURN_BEAMS (ALE_MAX_BEAMS - 1 + ALE_MAX_GAP_BEAMS)
#define MOST_BEAM (ALE_MAX_BEAMS - 1 + MOST_TURN_BEAMS)
#define MOST_STEP_NRAD INT64_C(3141592654)

static inline void unknown_directions(ale_beam_directions_t *directions)
{
    const uint32_t most_q36 = 1099511644; /* 2^30 + 16 as what a micrometre is multiplied by */
    const uint32_t sign = 0x80000000u;
    //@ loop unroll 1;
    for (uint32_t i = 0; i <= ALE_MAX_BEAMS; i++) {
        directions->cos_q36[i] = (uint32_t)unknown(0, most_q36) | (unknown(0, 1) ? sign : 0);
        directions->sin_q36[i] = (uint32_t)unknown(0, most_q36) | (unknown(0, 1) ? sign : 0);
    }
}

static inline void unknown_points(ale_points_t *points)
{
    points->directions = (int32_t)unknown(0, ALE_MAX_BEAMS);
    points->direction_step_bam = (int32_t)unknown(INT32_MIN, INT32_MAX);
    points->step_nrad = unknown(0, MOST_STEP_NRAD);
    points->turn_beams = (int32_t)unknown(0, MOST_TURN_BEAMS);
    points->frame_bam = (uint32_t)unknown(0, UINT32_MAX);
    points->count = (uint16_t)unknown(0, ALE_MAX_BEAMS);
    points->sparse = unknown(0, 1);
    points->gap_count = (uint16_t)unknown(0, ALE_MAX_BEAMS / ALE_MAX_GAP_BEAMS);
    unknown_directions(&points->direction[0]);
    unknown_directions(&points->direction[1]);
    //@ loop unroll 1;
    for (uint32_t i = 0; i < ALE_MAX_BEAMS; i++) {
        points->beam[i] = (uint16_t)unknown(0, MOST_BEAM);
        points->range_um[i] = (int32_t)unknown(ALE_MIN_RANGE_UM, ALE_MAX_RANGE_UM);
        points->inverse_q44[i] = (int32_t)unknown((INT64_C(1) << 44) / ALE_MAX_RANGE_UM, 1 << 30);
        points->x_q4[i] = (int32_t)unknown(-ALE_POINT_MAX_Q4, ALE_POINT_MAX_Q4);
        points->y_q4[i] = (int32_t)unknown(-ALE_POINT_MAX_Q4, ALE_POINT_MAX_Q4);
    }
    //@ loop unroll 1;
    for (uint32_t k = 0; k < sizeof points->gap_after / sizeof *points->gap_after; k++) {
        points->gap_after[k] = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1);
    }
}

/* As ale_scan_noise_measure leaves it, and run_noise.h corrects it. */
static inline void unknown_noise(ale_scan_noise_t *noise)
{
    Frama_C_make_unknown((char *)noise, sizeof *noise);
    noise->own_mm2_q36 = unknown(0, INT64_C(1) << 50); /* (128 mm)^2 */
    noise->own_relative_q36 = unknown(0, INT64_C(1) << 30);
    noise->own_square_q60 = unknown(0, INT64_C(1) << 29);
    noise->own_um2_q8 = unknown(0, INT64_C(1) << 37);
    noise->own_scale_q16 = unknown(180 << 8, 360 << 8);
    noise->shared_mm2_q36 = unknown(0, INT64_C(1) << 52);
    noise->shared_relative_q36 = unknown(0, INT64_C(1) << 32);
    noise->bearing_rad2_q36 = unknown(0, 687194767); /* (0.1 rad)^2 */
    noise->sigma_um = unknown(0, 131072);
    noise->sigma_per_range_q20 = unknown(0, 1 << 18);
    noise->shared_prior_mm2_q36 = unknown(0, INT64_C(1) << 50);
    noise->shared_prior_relative_q36 = unknown(0, INT64_C(1) << 30);
    noise->shared_beams = (int32_t)unknown(1, ALE_MAX_BEAMS);
    noise->bearing_nrad = (int32_t)unknown(0, 100000000);
    noise->shared_scale_q8 = unknown(64, 1024);
    noise->shared_stated_q8 = unknown(256, 1024);
    noise->shared_absent = unknown(0, 1);
}

static inline void unknown_segments(ale_segments_t *segments)
{
    segments->suspect_count = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1); /* the last point is none */
    segments->unruly = unknown(0, 1);
    segments->jump_at_seam = unknown(0, 1);
    segments->count = (uint16_t)unknown(0, ALE_MAX_BEAMS);
    //@ loop unroll 1;
    for (uint32_t k = 0; k < ALE_MAX_BEAMS; k++) {
        segments->suspect[k] = (uint16_t)unknown(0, ALE_MAX_BEAMS - 2);
        segments->jump_after[k] = unknown(0, 1);
        segments->segment[k].first = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1);
        segments->segment[k].last = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1);
    }
}

#endif
