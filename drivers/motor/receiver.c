#include "motor/receiver.h"

#define KEYED_TYPE 0x54300ec72fb5e816ULL /* LCM's fingerprints of ale.drive_keyed_t and ale.drive_ready_t */
#define READY_TYPE 0xd9ff83a56dd7e5daULL

enum { TAG = 8, HALF = 16, HELD_UP_MS = 200, DRIFT_FRAMES = 16 };

static uint64_t number_at(const uint8_t *bytes, int count, bool big)
{
    uint64_t value = 0;
    for (int k = 0; k < count; k++) {
        value = value << 8 | bytes[big ? k : count - 1 - k];
    }
    return value;
}

static void put(uint8_t *bytes, uint64_t value, bool big)
{
    for (int k = 0; k < 8; k++) {
        bytes[big ? 7 - k : k] = (uint8_t)(value >> 8 * k);
    }
}

static uint64_t turned(uint64_t x, int bits)
{
    return x << bits | x >> (64 - bits);
}

static void rounds(uint64_t v[4], int count)
{
    while (count-- > 0) {
        v[0] += v[1], v[2] += v[3];
        v[1] = turned(v[1], 13) ^ v[0], v[3] = turned(v[3], 16) ^ v[2];
        v[0] = turned(v[0], 32) + v[3], v[2] += v[1];
        v[3] = turned(v[3], 21) ^ v[0], v[1] = turned(v[1], 17) ^ v[2];
        v[2] = turned(v[2], 32);
    }
}

uint64_t ale_siphash(const uint8_t *key, const uint8_t *bytes, size_t count)
{
    const uint64_t k0 = number_at(key, 8, false), k1 = number_at(key + 8, 8, false);
    uint64_t v[4] = {k0 ^ 0x736f6d6570736575ULL, k1 ^ 0x646f72616e646f6dULL, k0 ^ 0x6c7967656e657261ULL,
                     k1 ^ 0x7465646279746573ULL};
    for (size_t at = 0; at <= count; at += 8) {
        const uint64_t end = (uint64_t)count << 56 | number_at(bytes + at, (int)(count - at) & 7, false);
        const uint64_t word = count - at >= 8 ? number_at(bytes + at, 8, false) : end;
        v[3] ^= word;
        rounds(v, 2);
        v[0] ^= word;
    }
    v[2] ^= 0xff;
    rounds(v, 4);
    return v[0] ^ v[1] ^ v[2] ^ v[3];
}

/* Zeros are a controller that nobody has given a key: everybody knows them. */
static bool has_key(const ale_motor_t *motor)
{
    uint8_t any = 0;
    for (int k = 0; k < ALE_MOTOR_KEY; k++) {
        any |= motor->key[k];
    }
    return any != 0;
}

/* Of messages that were held up, those that come late are refused. A clock that drifts is followed. */
static bool is_of_now(ale_motor_t *motor, uint32_t lead_ms, bool first)
{
    const int32_t held_up_ms = (int32_t)(motor->lead_ms - lead_ms);
    if (first || held_up_ms < 0) {
        motor->lead_ms = lead_ms;
    }
    motor->lead_ms -= motor->counter % DRIFT_FRAMES == 0;
    return first || held_up_ms <= HELD_UP_MS;
}

/* Of the same start of the robot a later one; of another start one that was made for the next nonce, which
 * nobody has used before. */
static bool is_next(ale_motor_t *motor, uint64_t boot, uint64_t nonce, uint64_t counter)
{
    const bool first = motor->counter == 0 || boot != motor->boot;
    if (nonce != (first ? motor->next : motor->nonce) || nonce == 0 ||
        (!first && counter <= motor->counter)) {
        return false;
    }
    motor->next = first ? ale_siphash(motor->key + HALF, (const uint8_t *)&nonce, sizeof nonce) : motor->next;
    motor->boot = boot;
    motor->nonce = nonce;
    motor->counter = counter;
    return true;
}

bool ale_motor_take(ale_motor_t *motor, const uint8_t *bytes, size_t count, uint32_t now_ms)
{
    if (!has_key(motor) || count != ALE_MOTOR_MESSAGE || number_at(bytes, 8, true) != KEYED_TYPE ||
        ale_siphash(motor->key, bytes, count - TAG) != number_at(bytes + count - TAG, TAG, false)) {
        return false;
    }
    const uint64_t before = motor->nonce;
    motor->utime = number_at(bytes + 8, 8, true);
    motor->heard = number_at(bytes + 16, 8, true);
    if (!is_next(motor, motor->heard, number_at(bytes + 24, 8, true), number_at(bytes + 32, 8, true)) ||
        !is_of_now(motor, (uint32_t)(motor->utime / 1000) - now_ms, motor->nonce != before)) {
        return false;
    }
    motor->v_um_s = (int32_t)number_at(bytes + 40, 4, true);
    motor->w_urad_s = (int32_t)number_at(bytes + 44, 4, true);
    motor->taken_ms = now_ms;
    motor->moves = true;
    return true;
}

void ale_motor_set_point(ale_motor_t *motor, uint32_t now_ms, int32_t *v_um_s, int32_t *w_urad_s)
{
    motor->moves = motor->moves && now_ms - motor->taken_ms < ALE_MOTOR_DEAD_MAN_MS;
    *v_um_s = motor->moves ? motor->v_um_s : 0;
    *w_urad_s = motor->moves ? motor->w_urad_s : 0;
}

size_t ale_motor_ready(const ale_motor_t *motor, uint8_t bytes[ALE_MOTOR_READY])
{
    const bool same = motor->counter != 0 && motor->heard == motor->boot;
    put(bytes, READY_TYPE, true);
    put(bytes + 8, motor->utime, true);
    put(bytes + 16, motor->heard, true);
    put(bytes + 24, same ? motor->nonce : motor->next, true);
    put(bytes + 32, ale_siphash(motor->key + HALF, bytes, ALE_MOTOR_READY - TAG), false);
    return ALE_MOTOR_READY;
}
