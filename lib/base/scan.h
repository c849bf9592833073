/* One scan of a 2D laser scanner: ranges, what each beam is worth, geometry and time.
 *
 *   bearing of beam k = first_bearing_bam + k * step_bam      (counter-clockwise positive; step may be
 *                                                              negative: a scanner mounted upside down)
 *   time of beam k    = stamp_us + (k - stamp_beam) * beam_time_ns / 1000
 *
 * A scanner whose points lie on no grid gives each beam a bearing of its own (own_bearings; base/turn.h makes
 * such a scan). Then step_bam is the mean step, in the order of the beams, and a beam's place on the grid, by
 * which its time goes, need not be whole: (bearing_bam[k] - first_bearing_bam) / step_bam.
 *
 * stamp_beam may lie outside 0..beams-1: the URG-04LX stamps its step 0, 44 steps before the first beam.
 * beam_time_ns 0 means that the whole scan was taken at its stamp.
 *
 * The scan is the caller's; no function keeps a pointer, returns an error or allocates. */
#ifndef ALE_BASE_SCAN_H
#define ALE_BASE_SCAN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"

/* What a beam is worth. Only ALE_BEAM_VALID has a range. */
typedef enum {
    ALE_BEAM_VALID = 0,
    ALE_BEAM_NO_RETURN = 1, /* nothing in reach (or nothing that reflects): free with low confidence */
    ALE_BEAM_UNKNOWN = 2,   /* weak, disturbed or dazzled: says nothing */
    ALE_BEAM_BLIND = 3,     /* the robot's own body, or not part of the field of view */
    ALE_BEAM_OUTLIER = 4,   /* set by the extractor: a stray point or a mixed pixel */
    ALE_BEAM_TOO_NEAR = 5   /* below the sensor's minimum distance */
} ale_beam_flag_t;

typedef struct {
    int64_t stamp_us;
    int32_t stamp_beam;
    int32_t beam_time_ns;
    uint32_t first_bearing_bam;
    int32_t step_bam;
    int32_t range_min_um; /* nearest and farthest distance the sensor can measure */
    int32_t range_max_um;
    uint16_t beams; /* 0..ALE_MAX_BEAMS */
    int32_t range_um[ALE_MAX_BEAMS];
    uint8_t flag[ALE_MAX_BEAMS]; /* ale_beam_flag_t */
    uint8_t code[ALE_MAX_BEAMS]; /* the device's raw error code where it gave one, else 0 */
    bool own_bearings;           /* bearing_bam holds, in place of the grid */
    uint32_t bearing_bam[ALE_MAX_BEAMS];
} ale_scan_t;

/* Bearing of a beam in the sensor's frame, BAM; outside 0..beams-1 that of the grid. Constant time. */
static inline uint32_t ale_scan_bearing(const ale_scan_t *scan, int32_t beam)
{
    if (scan->own_bearings && beam >= 0 && beam < scan->beams) {
        return scan->bearing_bam[beam];
    }
    return scan->first_bearing_bam + (uint32_t)beam * (uint32_t)scan->step_bam;
}

/* Beams of the whole turn where the first beam follows the last one within ALE_MAX_GAP_BEAMS, as though those
 * between had no value: beam k + ale_scan_turn_beams() is beam k. 0: the scan has two ends. Constant time. */
int32_t ale_scan_turn_beams(const ale_scan_t *scan);

/* Place of a beam with a bearing of its own among the evenly spaced ones, Q8: where its bearing lies, at most
 * one behind the last of them. Of a beam that is none, and without a step, its number. Constant time. */
/*@ assigns \nothing; */
int64_t ale_scan_own_place_q8(const ale_scan_t *scan, int32_t beam);

/* Place of any beam among the evenly spaced ones, Q8. Constant time. */
static inline int64_t ale_scan_place_q8(const ale_scan_t *scan, int32_t beam)
{
    return scan->own_bearings ? ale_scan_own_place_q8(scan, beam) : (int64_t)beam * 256;
}

/* Time of a beam relative to the stamp, in microseconds, rounded; it must fit int32. With bearings of their
 * own it follows from the bearing, for the mirror turns evenly. Constant time. */
int32_t ale_scan_beam_offset_us(const ale_scan_t *scan, int32_t beam);

/* Whether all beams lie within ALE_MAX_SWEEP_US of the stamp, whichever way the mirror turns: what readers of
 * files and of the line let pass. Constant time. */
bool ale_scan_is_sweep(const ale_scan_t *scan);

/* A sector of bearings (sensor frame) that is never used: from..to counter-clockwise. */
typedef struct {
    uint32_t from_bam;
    uint32_t to_bam;
} ale_sector_t;

/* Flags every beam whose bearing lies in one of the sectors as ALE_BEAM_BLIND, with range 0. The sectors are
 * read during the call alone. O(beams * count). */
void ale_scan_mask(ale_scan_t *scan, const ale_sector_t *sectors, uint32_t count);

/* Whether fewer than three in four echoes have an echo next to them. A scanner that leaves out beams, or
 * surfaces that swallow them, give such a scan. O(beams); in the header because the extractor, which asks for
 * every scan, is compiled so that it takes many beams at once. */
/*@ requires \valid_read(scan) && scan->beams <= ALE_MAX_BEAMS;
  @ assigns \nothing; */
static inline bool ale_scan_is_sparse(const ale_scan_t *scan)
{
    int32_t echoes = 0;
    int32_t with_next = 0;
    /*@ loop invariant 0 <= k <= ALE_MAX_BEAMS && 0 <= echoes <= k && 0 <= with_next <= k;
      @ loop assigns k, echoes, with_next; */
    for (int32_t k = 0; k + 1 < scan->beams; k++) {
        echoes += scan->flag[k] == ALE_BEAM_VALID;
        with_next += (scan->flag[k] | scan->flag[k + 1]) == ALE_BEAM_VALID;
    }
    return 4 * with_next < 3 * echoes;
}

/* In a sparse scan a missing echo between two others says nothing: flags those of at most
 * ALE_MAX_GAP_BEAMS - 1 neighbouring NO_RETURN beams as ALE_BEAM_UNKNOWN. O(beams). */
void ale_scan_forgive_missing(ale_scan_t *scan);

/* The meaning of a range value in mm of the URG-04LX, error codes below 20 included (SCIP 2.0 table for
 * this model): sets range, flag and code of one beam, 0..ALE_MAX_BEAMS-1. Values from 20 on are ranges, as in
 * ale_scan_set_range; negative ones count as code 0. value_mm below 2^31 / 1000. Constant time. */
void ale_scan_set_urg(ale_scan_t *scan, uint16_t beam, int32_t value_mm);

/* A range of any other sensor, for beam 0..ALE_MAX_BEAMS-1: 0, negative and from range_max on NO_RETURN;
 * below range_min TOO_NEAR; of these the range is 0. Constant time. */
void ale_scan_set_range(ale_scan_t *scan, uint16_t beam, int32_t range_um);

#endif
