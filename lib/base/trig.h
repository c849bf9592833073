/* Angles and trigonometry in integers.
 *
 * An angle is a uint32 in BAM, 2^32 to a turn: it wraps by itself, and one step of the URG-04LX
 * (360/1024 degrees) is exactly 2^22. Differences are taken as int32 (ale_bam_diff): -half..half turn.
 * cos and sin are Q30 from a table of 1024 steps to a turn (the URG's steps lie on its entries)
 * and a short series between them; odd and even symmetry is exact. Pure functions of constant time, no error.
 * Twin and bounds: tests/lib/base/test_trig.cpp (sin, cos within 2 units of Q30; atan2 within 3 BAM). */
#ifndef ALE_BASE_TRIG_H
#define ALE_BASE_TRIG_H

#include <stdint.h>

#define ALE_BAM_HALF_TURN 0x80000000u
#define ALE_BAM_QUARTER_TURN 0x40000000u

/* BAM of one degree, of one milliradian and of one radian: rounded to the nearest. */
#define ALE_BAM_PER_DEGREE 11930465
#define ALE_BAM_PER_MRAD 683565
#define ALE_BAM_PER_RAD 683565276

/* a - b, -half..half turn. */
/*@ assigns \nothing; */
static inline int32_t ale_bam_diff(uint32_t a_bam, uint32_t b_bam)
{
    return (int32_t)(a_bam - b_bam);
}

/* Q30: -2^30..2^30, within 2 units. */
/*@ assigns \nothing;
  @ ensures -1073741840 <= \result <= 1073741840; */
int32_t ale_cos_q30(uint32_t angle_bam);
/*@ assigns \nothing;
  @ ensures -1073741840 <= \result <= 1073741840; */
int32_t ale_sin_q30(uint32_t angle_bam);

/* A unit vector, or a rotation. */
typedef struct {
    int32_t cos_q30;
    int32_t sin_q30;
} ale_direction_t;

/* Both at once, at the cost of one. */
/*@ assigns \nothing;
  @ ensures -1073741840 <= \result.cos_q30 <= 1073741840;
  @ ensures -1073741840 <= \result.sin_q30 <= 1073741840; */
ale_direction_t ale_direction(uint32_t angle_bam);

/* Angle of the vector (x, y), any unit; |x|, |y| below 2^62; (0, 0) gives 0. */
/*@ requires -4611686018427387904 < x < 4611686018427387904;
  @ requires -4611686018427387904 < y < 4611686018427387904; */
uint32_t ale_atan2_bam(int64_t y, int64_t x);

/* Signed angle in BAM to nanoradians and back; |nrad| up to half a turn (3141592654). */
int64_t ale_bam_to_nrad(int32_t angle_bam);
int32_t ale_nrad_to_bam(int64_t angle_nrad);

#endif
