#include "motor/set_point.h"

#include <sodium.h>
#include <stdio.h>
#include <string.h>

#include <lcmtypes_ale_drive_keyed_t.h>
#include <lcmtypes_ale_drive_ready_t.h>

#include "motor/line_receiver.h"

enum { HALF = ALE_DRIVE_KEY_BYTES / 2, TAG = crypto_shorthash_BYTES, MICRO_PER_MILLI = 1000 };

_Static_assert((int)HALF == (int)crypto_shorthash_KEYBYTES, "one half of a key for each way");
_Static_assert((int)ALE_MOTOR_KEY == (int)ALE_DRIVE_KEY_BYTES, "the same key on both sides");

void ale_set_point_message(const ale_keyed_set_point_t *point, const ale_drive_key_t *key,
                           uint8_t bytes[ALE_MOTOR_MESSAGE])
{
    const lcmtypes_ale_drive_keyed_t message = {.utime = point->utime,
                                                .boot = point->boot,
                                                .nonce = point->nonce,
                                                .counter = point->counter,
                                                .v_um_s = point->v_um_s,
                                                .w_urad_s = point->w_urad_s};
    lcmtypes_ale_drive_keyed_t_encode(bytes, 0, ALE_MOTOR_MESSAGE, &message);
    crypto_shorthash(bytes + ALE_MOTOR_MESSAGE - TAG, bytes, ALE_MOTOR_MESSAGE - TAG, key->key);
}

bool ale_set_point_ready(const uint8_t *bytes, size_t count, const ale_drive_key_t *key, int64_t boot,
                         int64_t *nonce)
{
    uint8_t tag[TAG];
    lcmtypes_ale_drive_ready_t message;
    if (count != ALE_MOTOR_READY) {
        return false;
    }
    crypto_shorthash(tag, bytes, count - TAG, key->key + HALF);
    if (sodium_memcmp(tag, bytes + count - TAG, TAG) != 0 ||
        lcmtypes_ale_drive_ready_t_decode(bytes, 0, (int)count, &message) < 0 || message.boot != boot) {
        return false;
    }
    *nonce = message.nonce;
    return true;
}

size_t ale_set_point_line(uint32_t counter, int32_t v_um_s, int32_t w_urad_s, char line[ALE_SET_POINT_LINE])
{
    const size_t body = (size_t)snprintf(line, ALE_SET_POINT_LINE, "$ALE,%u,%d,%d", counter,
                                         v_um_s / MICRO_PER_MILLI, w_urad_s / MICRO_PER_MILLI);
    const uint16_t sum = ale_motor_crc(line + 1, body - 1);
    return body + (size_t)snprintf(line + body, ALE_SET_POINT_LINE - body, "*%04X\r\n", sum);
}
