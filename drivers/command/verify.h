/* Whether a command is to be obeyed. Pure: bytes, keys and the present in, a verdict out.
 *
 *   ale_verifier_t verifier;
 *   ale_verifier_init(&verifier, &keys, "rover", boot);
 *   if (ale_verify(&verifier, bytes, count, now_utime, &command) == ALE_GENUINE) ... obey command ...
 *
 * A replayed command is refused within one start of the robot by the counter of its key, which only grows,
 * and after a restart by the boot nonce: nothing has to be kept on disk. A stop is compared with stops alone:
 * one that was overtaken on its way, or that another program of the same operator has numbered lower, still
 * stops. A counter is of use for as long as a command lasts, so none may be farther ahead of the robot's
 * clock: no command, however it came to be signed, locks its operator out for longer. One owner thread. */
#ifndef ALE_COMMAND_VERIFY_H
#define ALE_COMMAND_VERIFY_H

#include <stddef.h>
#include <stdint.h>

#include "command/command.h"
#include "command/keys.h"

typedef enum {
    ALE_GENUINE,
    ALE_REFUSED_MALFORMED,
    ALE_REFUSED_UNSIGNED,
    ALE_REFUSED_STRANGER, /* nobody of that name has a key */
    ALE_REFUSED_FORGED,   /* the signature is not of that key and these bytes */
    ALE_REFUSED_ADDRESS,  /* for another robot */
    ALE_REFUSED_REPLAYED, /* for an earlier start, or not newer than the key's last one */
    ALE_REFUSED_LATE,     /* after its expiry */
    ALE_REFUSED_LASTING,  /* expires, or is numbered, later than a command may */
    ALE_VERDICTS
} ale_verdict_t;

typedef struct {
    ale_keys_t keys;
    char robot[ALE_NAME_BYTES];
    int64_t boot;
    int64_t newest[ALE_MAX_KEYS];      /* counter of the last genuine command of each key, */
    int64_t newest_stop[ALE_MAX_KEYS]; /* and of its last stop */
    uint64_t count[ALE_VERDICTS];
} ale_verifier_t;

/* robot: its name, copied. boot: the nonce of this start, as in ALE_STATUS. Cannot fail. */
void ale_verifier_init(ale_verifier_t *verifier, const ale_keys_t *keys, const char *robot, int64_t boot);

/* now_utime: the robot's clock. The verdict, counted. *command is set for ALE_GENUINE only. At most 1 kB is
 * looked at; one signature is checked, about 0.2 ms. */
ale_verdict_t ale_verify(ale_verifier_t *verifier, const uint8_t *bytes, size_t count, int64_t now_utime,
                         ale_command_t *command);

/* The name of its counter in ALE_STATUS: "command_forged". */
const char *ale_verdict_name(ale_verdict_t verdict);

#endif
