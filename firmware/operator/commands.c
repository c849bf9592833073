#include "operator/commands.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "operator/command_handlers.h"
#include "operator/explore_thread.h"
#include "recorder/recorder.h"

struct ale_commands {
    ale_command_handlers_t handlers;
    ale_verifier_t verifier;
    bool explored;                      /* exploration was on when last looked at */
    uint64_t refused;                   /* genuine commands that were not obeyed */
    char operator_name[ALE_NAME_BYTES]; /* of the answer */
    int64_t counter;
    bool obeyed;
};

ale_commands_t *ale_commands_create(const ale_config_t *config, const ale_keys_t *keys, int64_t boot,
                                    ale_exchange_t *exchange, ale_map_storage_t *storage)
{
    ale_commands_t *commands = calloc(1, sizeof *commands);
    if (!commands) {
        return NULL;
    }
    ale_command_handlers_init(&commands->handlers, config, exchange, storage);
    ale_verifier_init(&commands->verifier, keys, config->name, boot);
    return commands;
}

void ale_commands_destroy(ale_commands_t *commands)
{
    free(commands);
}

static void answer(ale_commands_t *commands, const char *name, int64_t counter, bool obeyed)
{
    memcpy(commands->operator_name, name, sizeof commands->operator_name);
    commands->counter = counter;
    commands->obeyed = obeyed;
    commands->refused += !obeyed;
}

/* For the flight recorder: what somebody wanted, and what came of it. */
static void record(const ale_commands_t *commands, const ale_command_t *command, bool begun)
{
    const ale_command_handlers_t *handlers = &commands->handlers;
    char text[ALE_NAME_BYTES * 2 + ALE_COMMAND_ARGS * ALE_COMMAND_ARG_BYTES + ALE_ANSWER_BYTES];
    int length = snprintf(text, sizeof text, "%s %s", command->operator_name, command->verb);
    for (uint32_t k = 0; k < command->args; k++) {
        length += snprintf(text + length, sizeof text - (size_t)length, " %s", command->arg[k]);
    }
    snprintf(text + length, sizeof text - (size_t)length, ": %s", begun ? "begun" : handlers->result);
    ale_recorder_command(handlers->exchange->recorder, handlers->now_us, text);
}

bool ale_commands_take(ale_commands_t *commands, const uint8_t *bytes, size_t count,
                       const ale_map_t *newest_map)
{
    ale_command_handlers_t *handlers = &commands->handlers;
    const ale_clock_t *clock = &handlers->exchange->clock;
    ale_command_t command;
    handlers->now_us = ale_clock_now_us(clock);
    if (ale_verify(&commands->verifier, bytes, count, ale_clock_to_utime(clock, handlers->now_us),
                   &command) != ALE_GENUINE) {
        return false;
    }
    const bool driving = strcmp(command.verb, "drive") == 0;
    const ale_job_t job_before = handlers->job;
    handlers->newest_map = newest_map;
    const bool obeyed = ale_command_handlers_obey(handlers, &command);
    const bool begun = handlers->job != job_before;
    if (!begun) {
        answer(commands, command.operator_name, command.counter, obeyed);
        handlers->news = handlers->news || !driving || !obeyed;
    }
    record(commands, &command, begun);
    return true;
}

/* That an exploration has begun or ended is news. */
static void watch_exploration(ale_commands_t *commands)
{
    ale_command_handlers_t *handlers = &commands->handlers;
    ale_explore_t *explore = handlers->exchange->explore;
    const bool on = explore && ale_explore_is_on(explore);
    handlers->news = handlers->news || on != commands->explored;
    commands->explored = on;
}

/* True when the map is saved or loaded, or could not be; the answer is written. */
static bool map_done(ale_command_handlers_t *handlers, bool *obeyed)
{
    ale_map_outcome_t outcome;
    if (!ale_map_storage_done(handlers->storage, &outcome)) {
        return false;
    }
    memcpy(handlers->result, outcome.text, sizeof handlers->result);
    *obeyed =
        outcome.fine && (!outcome.loaded || ale_command_handlers_request(handlers, &handlers->job_request));
    return true;
}

/* The same for a flight recording. */
static bool recording_done(ale_command_handlers_t *handlers, bool *obeyed)
{
    ale_record_outcome_t outcome;
    if (!ale_recorder_done(handlers->exchange->recorder, &outcome)) {
        return false;
    }
    memcpy(handlers->result, outcome.text, sizeof handlers->result);
    *obeyed = outcome.fine;
    return true;
}

/* The same for a way to a place; without a scan there is none. */
static bool goal_done(ale_command_handlers_t *handlers, bool *obeyed)
{
    ale_explore_t *explore = handlers->exchange->explore;
    const ale_goal_answer_t answer = ale_explore_goal_answer(explore, handlers->result);
    const int64_t now_us = ale_clock_now_us(&handlers->exchange->clock);
    *obeyed = answer == ALE_GOAL_TAKEN;
    if (answer == ALE_GOAL_PENDING && now_us - handlers->job_begun_us > ALE_GOAL_PATIENCE_US) {
        ale_explore_request(explore, false);
        snprintf(handlers->result, sizeof handlers->result, "no scan has come to plan a way with");
        return true;
    }
    return answer != ALE_GOAL_PENDING;
}

static bool job_done(ale_command_handlers_t *handlers, bool *obeyed)
{
    switch (handlers->job) {
    case ALE_JOB_MAP:
        return map_done(handlers, obeyed);
    case ALE_JOB_RECORDING:
        return recording_done(handlers, obeyed);
    case ALE_JOB_GOAL:
        return goal_done(handlers, obeyed);
    case ALE_JOB_NONE:
        break;
    }
    return false;
}

void ale_commands_work(ale_commands_t *commands)
{
    ale_command_handlers_t *handlers = &commands->handlers;
    bool obeyed = false;
    watch_exploration(commands);
    if (job_done(handlers, &obeyed)) {
        handlers->job = ALE_JOB_NONE;
        handlers->news = true;
        answer(commands, handlers->job_operator, handlers->job_counter, obeyed);
    }
}

bool ale_commands_news(ale_commands_t *commands)
{
    ale_command_handlers_t *handlers = &commands->handlers;
    const bool news = handlers->news;
    handlers->news = false;
    return news;
}

void ale_commands_report(const ale_commands_t *commands, ale_operation_report_t *report)
{
    const ale_command_handlers_t *handlers = &commands->handlers;
    const int64_t now_us = ale_clock_now_us(&handlers->exchange->clock);
    *report = (ale_operation_report_t){
        .takes_commands = commands->verifier.keys.count > 0,
        .map_frozen = handlers->map_frozen,
        .command_counter = commands->counter,
        .command_obeyed = commands->obeyed,
    };
    snprintf(report->robot, sizeof report->robot, "%s", handlers->config->name);
    snprintf(report->who_drives, sizeof report->who_drives, "%s",
             ale_drive_arbiter_holder(&handlers->arbiter, now_us));
    if (handlers->exchange->explore) {
        ale_explore_words(handlers->exchange->explore, report->exploration);
        if (report->who_drives[0] == '\0' && ale_explore_is_on(handlers->exchange->explore)) {
            snprintf(report->who_drives, sizeof report->who_drives, "%s",
                     ale_explore_is_going(handlers->exchange->explore) ? "goal" : "exploration");
        }
    }
    memcpy(report->command_operator, commands->operator_name, sizeof report->command_operator);
    memcpy(report->command_result, handlers->result, sizeof report->command_result);
}

void ale_commands_counters(const ale_commands_t *commands, ale_status_report_t *report)
{
    for (int verdict = 0; verdict < ALE_VERDICTS; verdict++) {
        report->counter[report->counters++] = (ale_counter_t){
            .name = ale_verdict_name((ale_verdict_t)verdict), .value = commands->verifier.count[verdict]};
    }
    report->counter[report->counters++] =
        (ale_counter_t){.name = "command_refused", .value = commands->refused};
}

bool ale_commands_publish_scan(const ale_commands_t *commands)
{
    return commands->handlers.publish_scan;
}
