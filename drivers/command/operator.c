#include "command/operator.h"

#include <stdio.h>
#include <string.h>

enum { PPM = 1000000, LEAST_SPAN_US = 100000 };

void ale_operator_saw(ale_operator_t *end, const char *robot, int64_t boot, int64_t utime, int64_t host_us)
{
    const bool same = boot == end->boot && strcmp(robot, end->robot) == 0;
    const int64_t span_us = host_us - end->seen_host_us;
    if (same && span_us < LEAST_SPAN_US) {
        return;
    }
    end->rate_ppm = same ? (utime - end->seen_utime) * PPM / span_us : 0;
    end->boot = boot;
    end->seen_utime = utime;
    end->seen_host_us = host_us;
    snprintf(end->robot, sizeof end->robot, "%s", robot);
}

static int64_t robot_utime(const ale_operator_t *end, int64_t host_us)
{
    const int64_t rate_ppm = end->rate_ppm > 0 ? end->rate_ppm : PPM;
    return end->seen_utime + (host_us - end->seen_host_us) * rate_ppm / PPM;
}

size_t ale_operator_command(ale_operator_t *end, int64_t host_us, int64_t life_us, ale_command_t *command,
                            uint8_t bytes[ALE_COMMAND_BYTES])
{
    if (end->robot[0] == '\0') {
        return 0;
    }
    command->utime = robot_utime(end, host_us);
    command->expiry_utime = command->utime + life_us;
    command->boot = end->boot;
    command->counter = command->utime > end->counter ? command->utime : end->counter + 1;
    memcpy(command->robot, end->robot, sizeof command->robot);
    end->counter = command->counter;
    return ale_command_sign(command, &end->key, bytes);
}

static bool copy_word(char *field, size_t size, const char *word)
{
    return snprintf(field, size, "%s", word) < (int)size;
}

int ale_command_from_words(const char *const *words, uint32_t count, ale_command_t *command)
{
    *command = (ale_command_t){0};
    if (count < 1 || count > ALE_COMMAND_ARGS + 1 ||
        !copy_word(command->verb, sizeof command->verb, words[0])) {
        return -1;
    }
    command->args = count - 1;
    for (uint32_t k = 0; k < command->args; k++) {
        if (!copy_word(command->arg[k], sizeof command->arg[k], words[k + 1])) {
            return -1;
        }
    }
    return 0;
}
