/* The operator's end: learns from ALE_STATUS which robot is there, which start of it this is and what its
 * clock says, and makes commands for it.
 *
 *   ale_operator_t operator_end = {.key = secret};
 *   ale_operator_saw(&operator_end, status.robot, status.boot, status.utime, host_us);    (every ALE_STATUS)
 *   n = ale_operator_command(&operator_end, host_us, ALE_COMMAND_LIFE_US / 2, &command, bytes);
 *
 * The operator's own clock only has to run evenly: nothing depends on its date. One owner thread. */
#ifndef ALE_COMMAND_OPERATOR_H
#define ALE_COMMAND_OPERATOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/command.h"
#include "command/keys.h"

typedef struct {
    ale_secret_key_t key;
    char robot[ALE_NAME_BYTES]; /* empty: no robot seen yet */
    int64_t boot;
    int64_t seen_utime; /* of the newest status, and when it came */
    int64_t seen_host_us;
    int64_t rate_ppm; /* the robot's clock against the host's; 0: not known yet, taken as even */
    int64_t counter;  /* of the last command made */
} ale_operator_t;

/* A status of the robot that was received at host_us, any even clock. */
void ale_operator_saw(ale_operator_t *end, const char *robot, int64_t boot, int64_t utime, int64_t host_us);

/* Completes a command of which verb and arguments are set, and signs it; it expires after life_us. The length
 * of the message, or 0: no robot seen yet, or a text that is too long. */
size_t ale_operator_command(ale_operator_t *end, int64_t host_us, int64_t life_us, ale_command_t *command,
                            uint8_t bytes[ALE_COMMAND_BYTES]);

/* Sets verb and arguments from words, words[0] the verb. 0, or -1: no word, too many, or one too long. */
int ale_command_from_words(const char *const *words, uint32_t count, ale_command_t *command);

#endif
