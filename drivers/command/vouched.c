#include "command/vouched.h"

#include <sodium.h>
#include <string.h>

enum { KEY_AT = 16, NUMBER_BYTES = 8 };

/* Big-endian, as LCM writes numbers. */
static int64_t number_at(const uint8_t *bytes)
{
    uint64_t value = 0;
    for (size_t k = 0; k < NUMBER_BYTES; k++) {
        value = value << 8 | bytes[k];
    }
    return (int64_t)value;
}

int64_t ale_vouched_key(const ale_public_key_t *key)
{
    return number_at(key->key);
}

void ale_vouched_sign(const ale_secret_key_t *secret, uint8_t *bytes, size_t count)
{
    const size_t signed_bytes = count - ALE_SIGNATURE_BYTES;
    crypto_sign_detached(bytes + signed_bytes, NULL, bytes, signed_bytes, secret->key);
}

static const ale_public_key_t *key_of(const ale_keys_t *robots, const uint8_t *bytes)
{
    for (uint32_t k = 0; k < robots->count; k++) {
        if (memcmp(robots->operator_key[k].key, bytes + KEY_AT, NUMBER_BYTES) == 0) {
            return &robots->operator_key[k];
        }
    }
    return NULL;
}

bool ale_is_vouched(const ale_keys_t *robots, const uint8_t *bytes, size_t count)
{
    if (count < (size_t)ALE_VOUCHED_HEAD + ALE_SIGNATURE_BYTES) {
        return false;
    }
    const ale_public_key_t *key = key_of(robots, bytes);
    const size_t signed_bytes = count - ALE_SIGNATURE_BYTES;
    return key && crypto_sign_verify_detached(bytes + signed_bytes, bytes, signed_bytes, key->key) == 0;
}

bool ale_may_be_called(const ale_keys_t *robots, int64_t key, const char *name)
{
    for (uint32_t k = 0; k < robots->count; k++) {
        const ale_public_key_t *robot = &robots->operator_key[k];
        if (strcmp(robot->name, name) == 0) {
            return ale_vouched_key(robot) == key;
        }
    }
    return true;
}

int64_t ale_digest(const uint8_t *bytes, size_t count)
{
    uint8_t digest[ALE_DIGEST_BYTES];
    crypto_generichash(digest, sizeof digest, bytes, count, NULL, 0);
    return number_at(digest);
}
