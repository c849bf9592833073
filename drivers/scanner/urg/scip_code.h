/* The coding of SCIP: numbers in characters of six bits, and the sum character. Pure functions. */
#ifndef ALE_SCANNER_URG_SCIP_CODE_H
#define ALE_SCANNER_URG_SCIP_CODE_H

#include <stddef.h>
#include <stdint.h>

/* Writes value in `characters` (1..4) characters, highest six bits first, each plus 0x30. */
void ale_scip_encode(uint32_t value, unsigned characters, uint8_t *out);

/* The value of `characters` (1..4) characters, or -1 when one lies outside 0x30..0x6F. */
int32_t ale_scip_decode(const uint8_t *in, unsigned characters);

/* Sum character of a run of bytes: low six bits of their sum, plus 0x30. */
uint8_t ale_scip_sum(const uint8_t *bytes, size_t count);

#endif
