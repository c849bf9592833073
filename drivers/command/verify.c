#include "command/verify.h"

#include <sodium.h>
#include <stdbool.h>
#include <string.h>

#include "command/message.h"

enum { NOBODY = -1 };

static const char *const names[ALE_VERDICTS] = {
    [ALE_GENUINE] = "command_genuine",           [ALE_REFUSED_MALFORMED] = "command_malformed",
    [ALE_REFUSED_UNSIGNED] = "command_unsigned", [ALE_REFUSED_STRANGER] = "command_stranger",
    [ALE_REFUSED_FORGED] = "command_forged",     [ALE_REFUSED_ADDRESS] = "command_other_robot",
    [ALE_REFUSED_REPLAYED] = "command_replayed", [ALE_REFUSED_LATE] = "command_late",
    [ALE_REFUSED_LASTING] = "command_lasting",
};

const char *ale_verdict_name(ale_verdict_t verdict)
{
    return names[verdict];
}

void ale_verifier_init(ale_verifier_t *verifier, const ale_keys_t *keys, const char *robot, int64_t boot)
{
    *verifier = (ale_verifier_t){.keys = *keys, .boot = boot};
    strncpy(verifier->robot, robot, sizeof verifier->robot - 1);
}

static int key_of(const ale_keys_t *keys, const char *name)
{
    for (uint32_t k = 0; k < keys->count; k++) {
        if (strcmp(keys->operator_key[k].name, name) == 0) {
            return (int)k;
        }
    }
    return NOBODY;
}

static bool is_stop(const ale_command_t *command)
{
    return strcmp(command->verb, "stop") == 0;
}

/* Of a command that its owner has signed. */
static ale_verdict_t judge(const ale_verifier_t *verifier, const ale_command_t *command, int key,
                           int64_t now_utime)
{
    if (strcmp(command->robot, verifier->robot) != 0) {
        return ALE_REFUSED_ADDRESS;
    }
    const int64_t newest = is_stop(command) ? verifier->newest_stop[key] : verifier->newest[key];
    if (command->boot != verifier->boot || command->counter <= newest) {
        return ALE_REFUSED_REPLAYED;
    }
    if (command->expiry_utime < now_utime) {
        return ALE_REFUSED_LATE;
    }
    const int64_t latest = now_utime + ALE_COMMAND_LIFE_US;
    return command->expiry_utime > latest || command->counter > latest ? ALE_REFUSED_LASTING : ALE_GENUINE;
}

static void note(ale_verifier_t *verifier, int key, const ale_command_t *command)
{
    if (is_stop(command)) {
        verifier->newest_stop[key] = command->counter;
    }
    if (command->counter > verifier->newest[key]) {
        verifier->newest[key] = command->counter;
    }
}

static ale_verdict_t verdict_of(ale_verifier_t *verifier, const uint8_t *bytes, size_t count,
                                int64_t now_utime, ale_command_t *command)
{
    size_t signed_bytes = 0;
    const ale_message_kind_t kind = ale_command_decode(bytes, count, command, &signed_bytes);
    if (kind != ALE_MESSAGE_SIGNED) {
        return kind == ALE_MESSAGE_UNSIGNED ? ALE_REFUSED_UNSIGNED : ALE_REFUSED_MALFORMED;
    }
    const int key = key_of(&verifier->keys, command->operator_name);
    if (key == NOBODY) {
        return ALE_REFUSED_STRANGER;
    }
    if (crypto_sign_verify_detached(bytes + count - ALE_SIGNATURE_BYTES, bytes, signed_bytes,
                                    verifier->keys.operator_key[key].key) != 0) {
        return ALE_REFUSED_FORGED;
    }
    const ale_verdict_t verdict = judge(verifier, command, key, now_utime);
    if (verdict == ALE_GENUINE) {
        note(verifier, key, command);
    }
    return verdict;
}

ale_verdict_t ale_verify(ale_verifier_t *verifier, const uint8_t *bytes, size_t count, int64_t now_utime,
                         ale_command_t *command)
{
    ale_command_t read = {0};
    const ale_verdict_t verdict = verdict_of(verifier, bytes, count, now_utime, &read);
    verifier->count[verdict]++;
    if (verdict == ALE_GENUINE) {
        *command = read;
    }
    return verdict;
}
