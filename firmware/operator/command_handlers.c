#include "operator/command_handlers.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "command/verb.h"
#include "config/decimal.h"
#include "exchange/wake.h"
#include "file/text.h"
#include "operator/explore_thread.h"
#include "recorder/recorder.h"

enum { MICRO = 6 };

#define ANSWER(commands, obeyed, ...)                                                                        \
    (snprintf((commands)->result, sizeof(commands)->result, __VA_ARGS__), (obeyed))

static bool read_metres(const char *text, int32_t *um)
{
    int64_t value = 0;
    if (ale_decimal_parse(text, MICRO, &value) < 0 || ale_abs64(value) > INT32_MAX) {
        return false;
    }
    *um = (int32_t)value;
    return true;
}

/* Three words: metres, metres, radians. */
static bool read_pose(const char words[][ALE_COMMAND_ARG_BYTES], ale_pose_t *pose)
{
    const ale_span_t angle = {.at = words[2], .end = words[2] + strlen(words[2])};
    return read_metres(words[0], &pose->x_um) && read_metres(words[1], &pose->y_um) &&
           ale_text_angle(angle, &pose->theta_bam);
}

static void give_orders(ale_commands_t *commands)
{
    *(ale_drive_orders_t *)ale_snapshot_back(commands->exchange->drive_orders) = commands->orders;
    ale_snapshot_publish(commands->exchange->drive_orders);
    ale_wake_post(commands->exchange->drive_again);
}

static bool drive(ale_commands_t *commands, const ale_command_t *command)
{
    ale_drive_arbiter_t *arbiter = &commands->arbiter;
    int32_t v_um_s = 0;
    int32_t w_urad_s = 0;
    if (!read_metres(command->arg[0], &v_um_s) || !read_metres(command->arg[1], &w_urad_s)) {
        return ANSWER(commands, false, "drive wants m/s and rad/s");
    }
    v_um_s = (int32_t)ale_clamp64(v_um_s, -commands->drive_um_s, commands->drive_um_s);
    w_urad_s = (int32_t)ale_clamp64(w_urad_s, -commands->drive_urad_s, commands->drive_urad_s);
    const bool begins = commands->now_us >= arbiter->request.valid_until_us;
    switch (ale_drive_arbiter_drive(arbiter, command->operator_name, v_um_s, w_urad_s, commands->now_us)) {
    case ALE_ARBITER_TAKEN:
        return ANSWER(commands, false, "%s drives", arbiter->holder);
    case ALE_ARBITER_STOPPED:
        return ANSWER(commands, false, "stopped: let go first");
    case ALE_ARBITER_GRANTED:
        break;
    }
    commands->orders.operator_request = arbiter->request;
    give_orders(commands);
    commands->news = commands->news || begins;
    return ANSWER(commands, true, "%s drives", command->operator_name);
}

static bool stop(ale_commands_t *commands, const ale_command_t *command)
{
    ale_drive_arbiter_stop(&commands->arbiter, commands->now_us);
    commands->orders = (ale_drive_orders_t){0};
    give_orders(commands);
    if (commands->exchange->explore) {
        ale_explore_request(commands->exchange->explore, false);
    }
    return ANSWER(commands, true, "stopped by %s", command->operator_name);
}

static bool explore(ale_commands_t *commands, const ale_command_t *command)
{
    const bool on = strcmp(command->arg[0], "on") == 0;
    if (!on && strcmp(command->arg[0], "off") != 0) {
        return ANSWER(commands, false, "explore on, or off");
    }
    if (!commands->exchange->explore) {
        return ANSWER(commands, false, "this robot does not explore");
    }
    const char *holder = ale_drive_arbiter_holder(&commands->arbiter, commands->now_us);
    if (on && holder[0] != '\0' && strcmp(holder, command->operator_name) != 0) {
        return ANSWER(commands, false, "%s drives", holder);
    }
    ale_explore_request(commands->exchange->explore, on);
    commands->orders.exploring = on;
    give_orders(commands);
    return ANSWER(commands, true, on ? "explores" : "exploration is off");
}

bool ale_command_handlers_request(ale_commands_t *commands, const ale_request_t *request)
{
    ale_request_t *slot = ale_ring_reserve(commands->exchange->requests);
    if (!slot) {
        return ANSWER(commands, false, "too much at once: try again");
    }
    *slot = *request;
    ale_ring_commit(commands->exchange->requests);
    ale_rt_release_post(commands->exchange->arrived);
    return true;
}

static bool ask_estimate(ale_commands_t *commands, ale_request_t request, const char *done)
{
    return ale_command_handlers_request(commands, &request) && ANSWER(commands, true, "%s", done);
}

static bool reset(ale_commands_t *commands, const ale_command_t *command)
{
    (void)command;
    return ask_estimate(commands, (ale_request_t){.kind = ALE_REQUEST_RESET}, "map and pose forgotten");
}

static bool relocate(ale_commands_t *commands, const ale_command_t *command)
{
    ale_request_t request = {.kind = ALE_REQUEST_RELOCATE};
    if (!read_pose(command->arg, &request.pose)) {
        return ANSWER(commands, false, "relocate wants x y theta, metres and radians");
    }
    return ask_estimate(commands, request, "put there: weak until scans agree");
}

static bool begin_job(ale_commands_t *commands, const ale_command_t *command, bool begun)
{
    if (!begun) {
        return ANSWER(commands, false, "busy with another map: try again");
    }
    commands->job_waits = true;
    commands->job_counter = command->counter;
    memcpy(commands->job_operator, command->operator_name, sizeof commands->job_operator);
    return true;
}

static bool save_map(ale_commands_t *commands, const ale_command_t *command)
{
    if (!ale_is_name(command->arg[0])) {
        return ANSWER(commands, false, "a map's name is letters, digits, '-', '_', '.'");
    }
    if (!commands->newest_map) {
        return ANSWER(commands, false, "no map yet");
    }
    return begin_job(commands, command,
                     ale_map_storage_save(commands->storage, command->arg[0], commands->newest_map));
}

static bool load_map(ale_commands_t *commands, const ale_command_t *command)
{
    ale_request_t request = {.kind = ALE_REQUEST_LOAD_MAP, .pose_known = command->args > 1};
    if (!ale_is_name(command->arg[0])) {
        return ANSWER(commands, false, "a map's name is letters, digits, '-', '_', '.'");
    }
    if (request.pose_known && (command->args != 4 || !read_pose(&command->arg[1], &request.pose))) {
        return ANSWER(commands, false, "load_map wants a name, or a name and x y theta");
    }
    commands->job_request = request;
    return begin_job(commands, command, ale_map_storage_load(commands->storage, command->arg[0]));
}

/* Settings that operators may change until the next start. */
static bool set_limit(ale_commands_t *commands, const ale_command_t *command, int32_t *limit, int64_t most)
{
    int32_t value = 0;
    if (!read_metres(command->arg[1], &value) || value < 0 || value > most) {
        char most_text[ALE_DECIMAL_TEXT];
        ale_decimal_print(most, MICRO, most_text);
        return ANSWER(commands, false, "%s is a number from 0 to %s", command->arg[0], most_text);
    }
    *limit = value;
    return ANSWER(commands, true, "%s is %s", command->arg[0], command->arg[1]);
}

static bool set_drive_speed(ale_commands_t *commands, const ale_command_t *command)
{
    return set_limit(commands, command, &commands->drive_um_s,
                     1000LL * commands->config->pipeline.max_speed_mm_s);
}

static bool set_drive_turn(ale_commands_t *commands, const ale_command_t *command)
{
    return set_limit(commands, command, &commands->drive_urad_s,
                     1000LL * commands->config->pipeline.max_turn_mrad_s);
}

/* A setting that is yes or no; *on is untouched when the word is neither. */
static bool set_switch(ale_commands_t *commands, const ale_command_t *command, bool *on)
{
    const bool yes = strcmp(command->arg[1], "yes") == 0;
    if (!yes && strcmp(command->arg[1], "no") != 0) {
        return ANSWER(commands, false, "%s is yes or no", command->arg[0]);
    }
    *on = yes;
    return ANSWER(commands, true, "%s is %s", command->arg[0], command->arg[1]);
}

static bool set_publish_scan(ale_commands_t *commands, const ale_command_t *command)
{
    return set_switch(commands, command, &commands->publish_scan);
}

static bool set_freeze_map(ale_commands_t *commands, const ale_command_t *command)
{
    bool on = commands->map_frozen;
    if (!set_switch(commands, command, &on)) {
        return false;
    }
    if (!ale_command_handlers_request(commands, &(ale_request_t){.kind = ALE_REQUEST_FREEZE, .on = on})) {
        return false;
    }
    commands->map_frozen = on;
    return true;
}

static bool record(ale_commands_t *commands, const ale_command_t *command)
{
    (void)command;
    if (!commands->exchange->recorder) {
        return ANSWER(commands, false, "this robot records no flights");
    }
    ale_recorder_trigger(commands->exchange->recorder, ALE_RECORD_COMMAND);
    return ANSWER(commands, true, "a flight recording is being written");
}

typedef bool (*handler_t)(ale_commands_t *commands, const ale_command_t *command);

static const handler_t settings[ALE_SETTINGS] = {
    [ALE_SETTING_DRIVE_SPEED] = set_drive_speed,
    [ALE_SETTING_DRIVE_TURN] = set_drive_turn,
    [ALE_SETTING_PUBLISH_SCAN] = set_publish_scan,
    [ALE_SETTING_FREEZE_MAP] = set_freeze_map,
};

static bool set(ale_commands_t *commands, const ale_command_t *command)
{
    return settings[ale_setting_of(command->arg[0])](commands, command);
}

static const handler_t verbs[ALE_VERBS] = {
    [ALE_VERB_DRIVE] = drive,       [ALE_VERB_STOP] = stop,         [ALE_VERB_EXPLORE] = explore,
    [ALE_VERB_RESET] = reset,       [ALE_VERB_RELOCATE] = relocate, [ALE_VERB_SAVE_MAP] = save_map,
    [ALE_VERB_LOAD_MAP] = load_map, [ALE_VERB_RECORD] = record,     [ALE_VERB_SET] = set,
};

bool ale_command_handlers_obey(ale_commands_t *commands, const ale_command_t *command)
{
    char error[ALE_VERB_ERROR];
    const int verb = ale_verb_of(command, error);
    return verb < 0 ? ANSWER(commands, false, "%s", error) : verbs[verb](commands, command);
}
