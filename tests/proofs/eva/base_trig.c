/* Angles: all of them, and all vectors that a direction may be asked of.
 *
 * proves: lib/base/trig.c
 * with: lib/base/fixed.c
 * settles: ale_direction ale_cos_q30 ale_sin_q30 ale_bam_diff ale_bam_to_nrad ale_nrad_to_bam ale_atan2_bam
 *  octant_arctan ratio_q40
 * options: -eva-slevel-function model_clzll:80 */
#include "unknown.h"

#include "base/trig.h"

/* The angles nearest to each entry of the table. A cosine is the sine of a quarter turn more. */
static void directions(void)
{
    const uint32_t half_step_bam = 1u << 21;
    //@ loop unroll 1024;
    for (uint32_t step = 0; step < 1024; step++) {
        const uint32_t entry_bam = step << 22;
        ale_sin_q30(entry_bam + (uint32_t)unknown(0, half_step_bam - 1));
        ale_cos_q30(entry_bam + half_step_bam);
        ale_sin_q30(entry_bam + half_step_bam);
        ale_sin_q30(entry_bam - (uint32_t)unknown(1, half_step_bam - 1));
    }
}

/* Vectors by the length of their longer coordinate. */
static void vectors(void)
{
    //@ loop unroll 63;
    for (unsigned bits = 0; bits <= 62; bits++) {
        //@ loop unroll 2;
        for (int negative = 0; negative <= 1; negative++) {
            const int64_t length = unknown_of_bits(bits, 0);
            const int64_t longer = negative ? -length : length;
            const int64_t most = ((int64_t)1 << bits) - 1;
            const int64_t shorter = unknown(-most, most);
            ale_atan2_bam(shorter, longer);
            ale_atan2_bam(longer, shorter);
        }
    }
}

void main(void)
{
    const uint32_t angle_bam = (uint32_t)unknown(0, UINT32_MAX);
    ale_bam_diff(angle_bam, (uint32_t)unknown(0, UINT32_MAX));
    ale_bam_to_nrad((int32_t)unknown(INT32_MIN, INT32_MAX));
    ale_nrad_to_bam(unknown(INT64_MIN, INT64_MAX));
    directions();
    vectors();
}
