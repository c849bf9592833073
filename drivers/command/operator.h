/* The operator's end: learns from the robot's status which robot is there, which start of it this is and what
 * its clock says, and makes commands for it.
 *
 *   ale_operator_t operator_end = {.key = secret, .robots = robots};
 *   if (ale_is_vouched(&operator_end.robots, bytes, count)) {                  (every ALE_VOUCHED, decoded)
 *       ale_operator_saw_vouched(&operator_end, &start, host_us);
 *   }
 *   ale_operator_saw(&operator_end, status.robot, status.boot, status.utime, host_us);    (every ALE_STATUS)
 *   n = ale_operator_command(&operator_end, host_us, ALE_COMMAND_LIFE_US / 2, &command, bytes);
 *
 * With robots that he believes only what they vouch for counts, and an ALE_STATUS is nothing to him. Without,
 * what comes first is followed for as long as it goes on; what contradicts it is not.
 *
 * The first robot that is heard is his, or the one that he wants; commands for another one are not made, but
 * for a stop, which may go to all that are heard: one that stands too many does no harm. Of a message that
 * came before another one of the same start, or of an earlier start, nothing is believed; but a start that
 * might be the true one is remembered, so that a stop can be sent to it, too.
 *
 * The operator's own clock only has to run evenly: nothing depends on its date. One owner thread. */
#ifndef ALE_COMMAND_OPERATOR_H
#define ALE_COMMAND_OPERATOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/command.h"
#include "command/keys.h"

/* Starts beside the present one that a stop goes to: of the same robot, and of other ones. */
enum { ALE_OPERATOR_SAME = 3, ALE_OPERATOR_ELSEWHERE = 16 };
enum { ALE_OPERATOR_OTHERS = ALE_OPERATOR_SAME + ALE_OPERATOR_ELSEWHERE, ALE_OPERATOR_SILENCE_US = 3000000 };

/* A start of a robot, as one message tells it. */
typedef struct {
    char robot[ALE_NAME_BYTES]; /* empty: none */
    int64_t key;                /* of vouched_t; 0: of an ALE_STATUS, which nobody vouches for */
    int64_t boot;
    int64_t counter; /* of vouched_t */
    int64_t utime;
    int64_t rate_ppm; /* the robot's clock against the host's; 0: not known yet, taken as even */
    int64_t host_us;  /* when it came; set by ale_operator_saw_vouched */
} ale_start_t;

/* By what a command was made: what is heard later may tell that it should be made again. */
typedef struct {
    bool stop;
    uint32_t met; /* how many starts had been heard until then */
    int64_t boot;
    int64_t utime;
    int64_t expiry_utime;
    int64_t host_us;
} ale_made_t;

typedef struct {
    ale_secret_key_t key;
    ale_keys_t robots;           /* that he believes; none: every ALE_STATUS */
    char wanted[ALE_NAME_BYTES]; /* empty: the first one that is heard */
    ale_start_t present;         /* commands are for it */
    /* Of the same robot, that contradict it; then of other robots, while none is wanted by its name. */
    ale_start_t other[ALE_OPERATOR_OTHERS];
    uint32_t met;               /* starts that were heard for the first time */
    char rival[ALE_NAME_BYTES]; /* another robot, heard at rival_host_us */
    int64_t rival_host_us;
    int64_t counter; /* of the last command made */
    ale_made_t made; /* the last command */
} ale_operator_t;

/* A status of a robot that was received at host_us, any even clock. Whether it is taken: it is of his robot,
 * and new. */
bool ale_operator_saw(ale_operator_t *end, const char *robot, int64_t boot, int64_t utime, int64_t host_us);

/* The same of a message for which a robot that he believes has vouched. */
bool ale_operator_saw_vouched(ale_operator_t *end, const ale_start_t *start, int64_t host_us);

/* Another robot that was heard lately: of another name, while none is wanted by its name, or of the same
 * name, so that nobody can tell which of both is meant. NULL: none. */
const char *ale_operator_rival(const ale_operator_t *end, int64_t host_us);

/* The robot's clock, as it is believed at host_us; 0: no robot seen yet. */
int64_t ale_operator_utime(const ale_operator_t *end, int64_t host_us);

/* Completes a command of which verb and arguments are set, and signs it; it expires after life_us. The length
 * of the message, or 0: no robot seen yet, or a text that is too long. */
size_t ale_operator_command(ale_operator_t *end, int64_t host_us, int64_t life_us, ale_command_t *command,
                            uint8_t bytes[ALE_COMMAND_BYTES]);

/* The same for one of the other starts, 0 to ALE_OPERATOR_OTHERS - 1, as far as it was heard lately: for a
 * stop, which should reach the robot whichever is the true one. 0: there is none. */
size_t ale_operator_command_other(ale_operator_t *end, int other, int64_t host_us, int64_t life_us,
                                  ale_command_t *command, uint8_t bytes[ALE_COMMAND_BYTES]);

/* Whether that command, one of end->made, did not reach whom it was for, as is known by now: it was made by
 * the word of an earlier start or hour, which somebody has played again, and has expired since; or it was a
 * stop, and there is a start that it was not sent to. Not before 100 ms after it was made, so that who floods
 * the bus does not have a flood of commands made. */
bool ale_operator_was_misled(const ale_operator_t *end, const ale_made_t *made, int64_t host_us);

/* Sets verb and arguments from words, words[0] the verb. 0, or -1: no word, too many, or one too long. */
int ale_command_from_words(const char *const *words, uint32_t count, ale_command_t *command);

#endif
