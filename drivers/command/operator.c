#include "command/operator.h"

#include <stdio.h>
#include <string.h>

enum { PPM = 1000000, LEAST_SPAN_US = 100000 };

/* Rates of a simulation's clock. */
enum { SLOWEST_PPM = PPM / 100 };
#define FASTEST_PPM (100 * (int64_t)PPM)

/* Times beyond are no times, and a clock is not foretold for longer: nothing overflows. */
#define LATEST_UTIME ((int64_t)1 << 60)
#define LONGEST_US 10000000000
enum { LONGEST_SPAN_US = 60000000 };

/* So far apart may two messages of one clock be for what they were held up on their way. */
enum { AGREE_US = 1000000, HELD_UP_US = 500000 };

/* A command is not made again before. */
enum { AGAIN_US = 100000 };

/* On that robot's clock. */
static int64_t passed_us(const ale_start_t *start, int64_t from_host_us, int64_t to_host_us)
{
    const int64_t rate_ppm = start->rate_ppm > 0 ? start->rate_ppm : PPM;
    const int64_t host_us = to_host_us - from_host_us;
    return (host_us < LONGEST_US ? host_us : LONGEST_US) * rate_ppm / PPM;
}

static int64_t utime_at(const ale_start_t *start, int64_t host_us)
{
    return start->utime + passed_us(start, start->host_us, host_us);
}

static bool is_silent(const ale_start_t *start, int64_t host_us)
{
    return start->robot[0] == '\0' || host_us - start->host_us > ALE_OPERATOR_SILENCE_US;
}

static bool is_same_robot(const ale_start_t *a, const ale_start_t *b)
{
    return a->key == b->key && strcmp(a->robot, b->robot) == 0;
}

/* Said by the same start, and not later. */
static bool is_before(const ale_start_t *start, const ale_start_t *heard)
{
    return is_same_robot(heard, start) && heard->boot == start->boot && start->counter <= heard->counter;
}

/* Another one of the same start, or an earlier one, was heard already. */
static bool is_replayed(const ale_operator_t *end, const ale_start_t *start)
{
    bool known = is_before(start, &end->present);
    for (int k = 0; k < ALE_OPERATOR_OTHERS; k++) {
        known = known || is_before(start, &end->other[k]);
    }
    return start->key != 0 && known;
}

static bool is_same_start(const ale_start_t *a, const ale_start_t *b)
{
    return a->boot == b->boot && is_same_robot(a, b);
}

static ale_start_t *remembered(ale_operator_t *end, const ale_start_t *start)
{
    for (int k = 0; k < ALE_OPERATOR_OTHERS; k++) {
        if (is_same_start(&end->other[k], start)) {
            return &end->other[k];
        }
    }
    return NULL;
}

/* In the place of the same start, or of the one that was not heard for longest. */
static void remember(ale_operator_t *end, const ale_start_t *start)
{
    const bool same_robot = is_same_robot(&end->present, start);
    const int last = same_robot ? ALE_OPERATOR_SAME : ALE_OPERATOR_OTHERS;
    ale_start_t *place = remembered(end, start);
    if (!place) {
        end->met++;
        place = &end->other[same_robot ? 0 : ALE_OPERATOR_SAME];
        for (ale_start_t *one = place; one < &end->other[last]; one++) {
            place = one->host_us < place->host_us ? one : place;
        }
    }
    *place = *start;
}

static bool adopt(ale_operator_t *end, const ale_start_t *start)
{
    const bool another = end->present.robot[0] != '\0' && end->present.boot != start->boot;
    ale_start_t *same = remembered(end, start);
    if (same) {
        *same = (ale_start_t){0};
    }
    if (another) {
        const ale_start_t before = end->present;
        remember(end, &before);
    }
    end->present = *start;
    return true;
}

/* Of his robot: it says no earlier time than the robot would. What does is a memory. */
static bool is_fresh(const ale_start_t *present, const ale_start_t *start)
{
    return start->utime - utime_at(present, start->host_us) >= -HELD_UP_US;
}

/* Of the same start. What a robot vouches for counts; an open clock goes on as it went. */
static bool agrees(const ale_start_t *present, const ale_start_t *start)
{
    const int64_t ahead_us = start->utime - utime_at(present, start->host_us);
    const int64_t agree_us = AGREE_US * (present->rate_ppm > PPM ? present->rate_ppm / PPM : 1);
    return start->key != 0 || present->rate_ppm == 0 || (ahead_us >= -agree_us && ahead_us <= agree_us);
}

static void note_rival(ale_operator_t *end, const ale_start_t *start)
{
    memcpy(end->rival, start->robot, sizeof end->rival);
    end->rival_host_us = start->host_us;
}

/* Another start of his robot, while the present one goes on: it has started again, once. Two that go on by
 * turns are two robots of one name. */
static bool saw_another_start(ale_operator_t *end, const ale_start_t *start)
{
    const bool fresh = is_fresh(&end->present, start);
    if (fresh && !remembered(end, start)) {
        return adopt(end, start);
    }
    if (fresh) {
        note_rival(end, start);
    }
    remember(end, start);
    return false;
}

static bool saw(ale_operator_t *end, const ale_start_t *start)
{
    const ale_start_t *present = &end->present;
    const bool unwanted = end->wanted[0] != '\0' && strcmp(end->wanted, start->robot) != 0;
    const bool first = present->robot[0] == '\0';
    if (unwanted || (!first && start->robot[0] == '\0') || is_replayed(end, start)) {
        return false;
    }
    if (!first && !is_same_robot(present, start)) {
        note_rival(end, start);
        remember(end, start);
        return false;
    }
    if (is_silent(present, start->host_us)) {
        return adopt(end, start);
    }
    if (start->boot != present->boot) {
        return saw_another_start(end, start);
    }
    if (!agrees(present, start)) {
        remember(end, start);
        return false;
    }
    return adopt(end, start);
}

/* Nobody says how fast an open clock runs: what two messages tell, within reason. */
static int64_t rate_of(const ale_start_t *before, int64_t utime, int64_t span_us)
{
    const int64_t went_us = utime - before->utime;
    const int64_t most_us = span_us * (FASTEST_PPM / PPM);
    if (span_us > LONGEST_SPAN_US || went_us < 0 || went_us > most_us) {
        return 0;
    }
    const int64_t rate_ppm = went_us * PPM / span_us;
    return rate_ppm >= SLOWEST_PPM ? rate_ppm : 0;
}

static bool is_time(int64_t utime)
{
    return utime >= 0 && utime <= LATEST_UTIME;
}

bool ale_operator_saw(ale_operator_t *end, const char *robot, int64_t boot, int64_t utime, int64_t host_us)
{
    if (end->robots.count > 0 || !is_time(utime)) {
        return false;
    }
    ale_start_t start = {.boot = boot, .utime = utime, .host_us = host_us};
    snprintf(start.robot, sizeof start.robot, "%s", robot);
    const ale_start_t *present = &end->present;
    if (is_same_robot(present, &start) && present->boot == boot) {
        const int64_t span_us = host_us - present->host_us;
        if (span_us < LEAST_SPAN_US) {
            return true;
        }
        start.rate_ppm = rate_of(present, utime, span_us);
    }
    return saw(end, &start);
}

bool ale_operator_saw_vouched(ale_operator_t *end, const ale_start_t *start, int64_t host_us)
{
    ale_start_t heard = *start;
    heard.host_us = host_us;
    return is_time(start->utime) && start->rate_ppm >= SLOWEST_PPM && start->rate_ppm <= FASTEST_PPM &&
           saw(end, &heard);
}

const char *ale_operator_rival(const ale_operator_t *end, int64_t host_us)
{
    const bool lately = end->rival[0] != '\0' && host_us - end->rival_host_us <= ALE_OPERATOR_SILENCE_US;
    return lately ? end->rival : NULL;
}

int64_t ale_operator_utime(const ale_operator_t *end, int64_t host_us)
{
    return end->present.robot[0] != '\0' ? utime_at(&end->present, host_us) : 0;
}

/* A robot has taken none that is farther ahead than a command lasts: then the last one was made by a clock
 * that was not the robot's, and nothing has to be above it. */
static int64_t counter_after(int64_t last, int64_t utime)
{
    return utime > last || last - utime >= ALE_COMMAND_LIFE_US ? utime : last + 1;
}

static size_t command_for(ale_operator_t *end, const ale_start_t *start, int64_t host_us, int64_t life_us,
                          ale_command_t *command, uint8_t bytes[ALE_COMMAND_BYTES])
{
    command->utime = utime_at(start, host_us);
    command->expiry_utime = command->utime + life_us;
    command->boot = start->boot;
    command->counter = counter_after(end->counter, command->utime);
    memcpy(command->robot, start->robot, sizeof command->robot);
    return ale_command_sign(command, &end->key, bytes);
}

size_t ale_operator_command(ale_operator_t *end, int64_t host_us, int64_t life_us, ale_command_t *command,
                            uint8_t bytes[ALE_COMMAND_BYTES])
{
    if (end->present.robot[0] == '\0') {
        return 0;
    }
    const size_t count = command_for(end, &end->present, host_us, life_us, command, bytes);
    end->counter = command->counter;
    end->made = (ale_made_t){.stop = strcmp(command->verb, "stop") == 0,
                             .met = end->met,
                             .boot = command->boot,
                             .utime = command->utime,
                             .expiry_utime = command->expiry_utime,
                             .host_us = host_us};
    return count;
}

size_t ale_operator_command_other(ale_operator_t *end, int other, int64_t host_us, int64_t life_us,
                                  ale_command_t *command, uint8_t bytes[ALE_COMMAND_BYTES])
{
    const ale_start_t *start = &end->other[other];
    return is_silent(start, host_us) ? 0 : command_for(end, start, host_us, life_us, command, bytes);
}

bool ale_operator_was_misled(const ale_operator_t *end, const ale_made_t *made, int64_t host_us)
{
    if (host_us - made->host_us < AGAIN_US) {
        return false;
    }
    const int64_t utime = utime_at(&end->present, host_us);
    const int64_t jump_us = utime - made->utime - passed_us(&end->present, made->host_us, host_us);
    const bool unmet = made->stop && made->met != end->met;
    const bool over = made->stop || utime > made->expiry_utime;
    return end->present.boot != made->boot || unmet || (jump_us > HELD_UP_US && over);
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
