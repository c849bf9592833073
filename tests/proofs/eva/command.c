/* Any bytes as a command or as a robot's word, to a robot or an operator with any keys.
 *
 * proves: drivers/command/message.c drivers/command/verify.c drivers/command/verb.c drivers/command/vouched.c
 * options: -eva-slevel 40 -eva-auto-loop-unroll 40 */
#include "unknown.h"

#include <string.h>

#include <lcmtypes_ale_command_t.h>

#include "command/message.h"
#include "command/verb.h"
#include "command/verify.h"
#include "command/vouched.h"

/* LCM's writer and the type's number stand for themselves: they get nothing that came from outside. */
int lcmtypes_ale_command_t_encode(void *bytes, int offset, int most, const lcmtypes_ale_command_t *message)
{
    (void)message;
    Frama_C_make_unknown((char *)bytes + offset, (size_t)most);
    return (int)unknown(-1, most);
}

int64_t __lcmtypes_ale_command_t_get_hash(void)
{
    return INT64_C(0x7a1f00d5c0ffee11);
}

static void unknown_keys(ale_keys_t *keys)
{
    Frama_C_make_unknown((char *)keys, sizeof *keys);
    keys->count = (uint32_t)unknown(0, ALE_MAX_KEYS);
    //@ loop unroll 16;
    for (uint32_t k = 0; k < ALE_MAX_KEYS; k++) {
        keys->operator_key[k].name[ALE_NAME_BYTES - 1] = '\0';
    }
}

static void obey(const ale_command_t *command)
{
    char error[ALE_VERB_ERROR];
    uint8_t bytes[ALE_COMMAND_BYTES];
    uint8_t signature[ALE_SIGNATURE_BYTES] = {0};
    ale_verb_of(command, error);
    ale_setting_of(command->arg[0]);
    ale_command_encode(command, unknown(0, 1) ? signature : NULL, bytes);
}

void main(void)
{
    static ale_verifier_t verifier;
    static uint8_t bytes[ALE_COMMAND_BYTES];
    ale_keys_t keys;
    char robot[ALE_NAME_BYTES];
    unknown_keys(&keys);
    Frama_C_make_unknown(robot, sizeof robot);
    robot[sizeof robot - 1] = '\0';
    ale_verifier_init(&verifier, &keys, robot, unknown(INT64_MIN, INT64_MAX));
    while (unknown(0, 1)) {
        ale_command_t command = {0};
        Frama_C_make_unknown((char *)bytes, sizeof bytes);
        const size_t count = (size_t)unknown(0, sizeof bytes);
        const int64_t now_utime = unknown(0, INT64_C(1) << 61);
        const ale_verdict_t verdict = ale_verify(&verifier, bytes, count, now_utime, &command);
        ale_verdict_name(verdict);
        if (verdict == ALE_GENUINE) {
            obey(&command);
        }
        ale_is_vouched(&keys, bytes, count);
        ale_may_be_called(&keys, unknown(INT64_MIN, INT64_MAX), robot);
        ale_digest(bytes, count);
    }
    ale_secret_key_t secret = {0};
    ale_vouched_sign(&secret, bytes, (size_t)unknown(ALE_SIGNATURE_BYTES, sizeof bytes));
}
