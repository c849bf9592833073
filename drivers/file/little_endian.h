/* Integers as bytes, lowest first: what files hold, whatever the machine. Pure functions. */
#ifndef ALE_FILE_LITTLE_ENDIAN_H
#define ALE_FILE_LITTLE_ENDIAN_H

#include <stdint.h>

static inline void ale_put_u32(uint8_t *out, uint32_t value)
{
    for (unsigned i = 0; i < 4; i++) {
        out[i] = (uint8_t)(value >> (8 * i));
    }
}

static inline void ale_put_u64(uint8_t *out, uint64_t value)
{
    for (unsigned i = 0; i < 8; i++) {
        out[i] = (uint8_t)(value >> (8 * i));
    }
}

static inline void ale_put_u16(uint8_t *out, uint16_t value)
{
    out[0] = (uint8_t)value;
    out[1] = (uint8_t)(value >> 8);
}

static inline uint16_t ale_get_u16(const uint8_t *in)
{
    return (uint16_t)(in[0] | in[1] << 8);
}

static inline uint32_t ale_get_u32(const uint8_t *in)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < 4; i++) {
        value |= (uint32_t)in[i] << (8 * i);
    }
    return value;
}

static inline uint64_t ale_get_u64(const uint8_t *in)
{
    return ale_get_u32(in) | (uint64_t)ale_get_u32(in + 4) << 32;
}

#endif
