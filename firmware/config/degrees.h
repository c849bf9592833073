/* Angles as people write them: degrees as decimal text to BAM and back. Pure functions, any thread. */
#ifndef ALE_FIRMWARE_CONFIG_DEGREES_H
#define ALE_FIRMWARE_CONFIG_DEGREES_H

#include <stdint.h>

#include "config/decimal.h"

/* Degrees as text to BAM, rounded; -360 to 360. 0, or -1 when text is no such number (then *bam is
 * untouched). */
int ale_degrees_parse(const char *text, uint32_t *bam);

/* The shortest decimal in degrees, -180 to 180, that ale_degrees_parse reads back to the same angle. */
void ale_degrees_print(uint32_t bam, char text[ALE_DECIMAL_TEXT]);

#endif
