#include "scanner/urg/scip_code.h"

enum { CODE_BASE = 0x30, CODE_MASK = 0x3f, CODE_LAST = 0x6f };

void ale_scip_encode(uint32_t value, unsigned characters, uint8_t *out)
{
    for (unsigned k = 0; k < characters; k++) {
        const unsigned shift = 6 * (characters - 1 - k);
        out[k] = (uint8_t)(((value >> shift) & CODE_MASK) + CODE_BASE);
    }
}

int32_t ale_scip_decode(const uint8_t *in, unsigned characters)
{
    int32_t value = 0;
    for (unsigned k = 0; k < characters; k++) {
        if (in[k] < CODE_BASE || in[k] > CODE_LAST) {
            return -1;
        }
        value = value << 6 | (in[k] - CODE_BASE);
    }
    return value;
}

uint8_t ale_scip_sum(const uint8_t *bytes, size_t count)
{
    uint32_t sum = 0;
    for (size_t k = 0; k < count; k++) {
        sum += bytes[k];
    }
    return (uint8_t)((sum & CODE_MASK) + CODE_BASE);
}
