/* Decimal text to scaled integers and back, without floating point: the same on every machine and
 * independent of the locale.  "0.145" with 6 digits is 145000.  Pure functions, any thread. */
#ifndef ALE_FIRMWARE_CONFIG_DECIMAL_H
#define ALE_FIRMWARE_CONFIG_DECIMAL_H

#include <stdint.h>

enum { ALE_DECIMAL_TEXT = 32 };

/* The number in text (sign, digits, at most one point, nothing else) times 10^digits, digits 0..9; what
 * lies beyond is rounded half away from zero. 0, or -1 when text is no such number or |number| exceeds
 * 10^9 (then *out is untouched). */
int ale_decimal_parse(const char *text, unsigned digits, int64_t *out);

/* value / 10^digits, digits 0..9, without superfluous zeros: what ale_decimal_parse reads back exactly. */
void ale_decimal_print(int64_t value, unsigned digits, char out[ALE_DECIMAL_TEXT]);

/* value, which has `digits` digits after the point, rounded half away from zero to `kept` <= digits. */
int64_t ale_decimal_round(int64_t value, unsigned digits, unsigned kept);

#endif
