/* Segments of any values and beams, with windows of every span.
 *
 * proves: lib/extract/lowess.c
 * with: lib/base/fixed.c lib/base/histogram.c
 * options: -eva-precision 0 -eva-slevel-function model_clzll:80,first_pass:40 */
#include "unknown.h"

#include "extract/lowess.h"

static uint16_t beam[ALE_MAX_BEAMS];
static int32_t value[ALE_MAX_BEAMS];
static int32_t smooth[ALE_MAX_BEAMS];
static ale_lowess_work_t work;

static void unknown_values(void)
{
    //@ loop unroll 1;
    for (uint32_t i = 0; i < ALE_MAX_BEAMS; i++) {
        beam[i] = (uint16_t)unknown(0, UINT16_MAX);
        value[i] = (int32_t)unknown(-(1 << 30) + 1, (1 << 30) - 1);
    }
}

void main(void)
{
    unknown_values();
    const ale_lowess_config_t config = {
        .span = (uint16_t)(2 * unknown(0, ALE_MAX_SPAN / 2) + 1),
        .passes = (uint8_t)unknown(0, 8),
        .mad_floor = (int32_t)unknown(1, INT32_MAX),
    };
    ale_lowess(&config, beam, value, (int32_t)unknown(0, ALE_MAX_BEAMS), smooth, &work);
}
