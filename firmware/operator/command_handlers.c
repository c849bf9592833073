#include "operator/command_handlers.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "command/keys.h"
#include "command/verb.h"
#include "config/decimal.h"
#include "exchange/wake.h"
#include "file/text.h"
#include "operator/explore_thread.h"
#include "recorder/recorder.h"

enum { MICRO = 6 };

#define ANSWER(handlers, obeyed, ...)                                                                        \
    (snprintf((handlers)->result, sizeof(handlers)->result, __VA_ARGS__), (obeyed))

void ale_command_handlers_init(ale_command_handlers_t *handlers, const ale_config_t *config,
                               ale_exchange_t *exchange, ale_map_storage_t *storage)
{
    *handlers = (ale_command_handlers_t){
        .config = config,
        .exchange = exchange,
        .storage = storage,
        .publish_scan = config->publish_scan,
        .drive_um_s = config->drive_um_s,
        .drive_urad_s = config->drive_urad_s,
    };
}

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

static void give_orders(ale_command_handlers_t *handlers)
{
    *(ale_drive_orders_t *)ale_snapshot_back(handlers->exchange->drive_orders) = handlers->orders;
    ale_snapshot_publish(handlers->exchange->drive_orders);
    ale_wake_post(handlers->exchange->drive_again);
}

/* Who takes the stick decides where the robot goes, from then on. */
static void call_off_goal(ale_command_handlers_t *handlers)
{
    if (handlers->exchange->explore && ale_explore_is_going(handlers->exchange->explore)) {
        ale_explore_request(handlers->exchange->explore, false);
        handlers->orders.exploring = false;
    }
}

static bool drive(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    ale_drive_arbiter_t *arbiter = &handlers->arbiter;
    int32_t v_um_s = 0;
    int32_t w_urad_s = 0;
    if (!read_metres(command->arg[0], &v_um_s) || !read_metres(command->arg[1], &w_urad_s)) {
        return ANSWER(handlers, false, "drive wants m/s and rad/s");
    }
    v_um_s = (int32_t)ale_clamp64(v_um_s, -handlers->drive_um_s, handlers->drive_um_s);
    w_urad_s = (int32_t)ale_clamp64(w_urad_s, -handlers->drive_urad_s, handlers->drive_urad_s);
    const bool begins = handlers->now_us >= arbiter->request.valid_until_us;
    switch (ale_drive_arbiter_drive(arbiter, command->operator_name, v_um_s, w_urad_s, handlers->now_us)) {
    case ALE_ARBITER_TAKEN:
        return ANSWER(handlers, false, "%s drives", arbiter->holder);
    case ALE_ARBITER_STOPPED:
        return ANSWER(handlers, false, "stopped: let go first");
    case ALE_ARBITER_GRANTED:
        break;
    }
    call_off_goal(handlers);
    handlers->orders.operator_request = arbiter->request;
    give_orders(handlers);
    handlers->news = handlers->news || begins;
    return ANSWER(handlers, true, "%s drives", command->operator_name);
}

static bool stop(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    ale_drive_arbiter_stop(&handlers->arbiter, handlers->now_us);
    handlers->orders = (ale_drive_orders_t){0};
    give_orders(handlers);
    if (handlers->exchange->explore) {
        ale_explore_request(handlers->exchange->explore, false);
    }
    return ANSWER(handlers, true, "stopped by %s", command->operator_name);
}

static bool drives_by_itself(ale_command_handlers_t *handlers)
{
    return handlers->exchange->explore || ANSWER(handlers, false, "this robot does not explore");
}

/* Whether the robot may set off because this operator says so. */
static bool may_set_off(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    const char *holder = ale_drive_arbiter_holder(&handlers->arbiter, handlers->now_us);
    const bool taken = holder[0] != '\0' && strcmp(holder, command->operator_name) != 0;
    return !taken || ANSWER(handlers, false, "%s drives", holder);
}

static bool explore(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    const bool on = strcmp(command->arg[0], "on") == 0;
    if (!on && strcmp(command->arg[0], "off") != 0) {
        return ANSWER(handlers, false, "explore on, or off");
    }
    if (!drives_by_itself(handlers) || (on && !may_set_off(handlers, command))) {
        return false;
    }
    ale_explore_request(handlers->exchange->explore, on);
    handlers->orders.exploring = on;
    give_orders(handlers);
    return ANSWER(handlers, true, on ? "explores" : "exploration is off");
}

bool ale_command_handlers_request(ale_command_handlers_t *handlers, const ale_request_t *request)
{
    ale_request_t *slot = ale_ring_reserve(handlers->exchange->requests);
    if (!slot) {
        return ANSWER(handlers, false, "too much at once: try again");
    }
    *slot = *request;
    ale_ring_commit(handlers->exchange->requests);
    ale_rt_release_post(handlers->exchange->arrived);
    return true;
}

static bool ask_estimate(ale_command_handlers_t *handlers, ale_request_t request, const char *done)
{
    return ale_command_handlers_request(handlers, &request) && ANSWER(handlers, true, "%s", done);
}

static bool reset(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    (void)command;
    return ask_estimate(handlers, (ale_request_t){.kind = ALE_REQUEST_RESET}, "map and pose forgotten");
}

static bool relocate(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    ale_request_t request = {.kind = ALE_REQUEST_RELOCATE};
    if (!read_pose(command->arg, &request.pose)) {
        return ANSWER(handlers, false, "relocate wants x y theta, metres and radians");
    }
    return ask_estimate(handlers, request, "put there: weak until scans agree");
}

/* begun: whoever does it has taken it on. */
static bool begin_job(ale_command_handlers_t *handlers, const ale_command_t *command, ale_job_t job,
                      bool begun)
{
    if (!begun) {
        return ANSWER(handlers, false, "busy: try again");
    }
    handlers->job = job;
    handlers->job_counter = command->counter;
    handlers->job_begun_us = handlers->now_us;
    memcpy(handlers->job_operator, command->operator_name, sizeof handlers->job_operator);
    return true;
}

/* One job at a time: its answer is still to be told. */
static bool has_no_job(ale_command_handlers_t *handlers)
{
    static const char *const jobs[] = {[ALE_JOB_NONE] = "",
                                       [ALE_JOB_MAP] = "map",
                                       [ALE_JOB_RECORDING] = "recording",
                                       [ALE_JOB_GOAL] = "goal"};
    return handlers->job == ALE_JOB_NONE ||
           ANSWER(handlers, false, "busy with another %s: try again", jobs[handlers->job]);
}

static bool go_to(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    ale_point_t place;
    if (!read_metres(command->arg[0], &place.x_um) || !read_metres(command->arg[1], &place.y_um)) {
        return ANSWER(handlers, false, "goto wants x y, metres");
    }
    if (!drives_by_itself(handlers) || !may_set_off(handlers, command) || !has_no_job(handlers)) {
        return false;
    }
    ale_explore_go(handlers->exchange->explore, place, handlers->newest_map);
    handlers->orders.exploring = true;
    give_orders(handlers);
    return begin_job(handlers, command, ALE_JOB_GOAL, true);
}

static bool save_map(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    if (!ale_is_name(command->arg[0])) {
        return ANSWER(handlers, false, "a map's name is letters, digits, '-', '_', '.'");
    }
    if (!handlers->newest_map) {
        return ANSWER(handlers, false, "no map yet");
    }
    return has_no_job(handlers) &&
           begin_job(handlers, command, ALE_JOB_MAP,
                     ale_map_storage_save(handlers->storage, command->arg[0], handlers->newest_map));
}

static bool load_map(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    ale_request_t request = {.kind = ALE_REQUEST_LOAD_MAP, .pose_known = command->args > 1};
    if (!ale_is_name(command->arg[0])) {
        return ANSWER(handlers, false, "a map's name is letters, digits, '-', '_', '.'");
    }
    if (request.pose_known && (command->args != 4 || !read_pose(&command->arg[1], &request.pose))) {
        return ANSWER(handlers, false, "load_map wants a name, or a name and x y theta");
    }
    if (!has_no_job(handlers)) {
        return false;
    }
    handlers->job_request = request;
    return begin_job(handlers, command, ALE_JOB_MAP,
                     ale_map_storage_load(handlers->storage, command->arg[0]));
}

/* Settings that operators may change until the next start. A limit goes down and up again, never above what
 * the configuration calls the most. */
static bool set_limit(ale_command_handlers_t *handlers, const ale_command_t *command, int32_t *limit,
                      int32_t most)
{
    int32_t value = 0;
    if (!read_metres(command->arg[1], &value) || value < 0 || value > most) {
        char most_text[ALE_DECIMAL_TEXT];
        ale_decimal_print(most, MICRO, most_text);
        return ANSWER(handlers, false, "%s is a number from 0 to %s", command->arg[0], most_text);
    }
    *limit = value;
    return ANSWER(handlers, true, "%s is %s", command->arg[0], command->arg[1]);
}

static bool set_drive_speed(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    return set_limit(handlers, command, &handlers->drive_um_s, handlers->config->drive_um_s);
}

static bool set_drive_turn(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    return set_limit(handlers, command, &handlers->drive_urad_s, handlers->config->drive_urad_s);
}

/* A setting that is yes or no; *on is untouched when the word is neither. */
static bool set_switch(ale_command_handlers_t *handlers, const ale_command_t *command, bool *on)
{
    const bool yes = strcmp(command->arg[1], "yes") == 0;
    if (!yes && strcmp(command->arg[1], "no") != 0) {
        return ANSWER(handlers, false, "%s is yes or no", command->arg[0]);
    }
    *on = yes;
    return ANSWER(handlers, true, "%s is %s", command->arg[0], command->arg[1]);
}

static bool set_publish_scan(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    return set_switch(handlers, command, &handlers->publish_scan);
}

static bool set_freeze_map(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    bool on = handlers->map_frozen;
    if (!set_switch(handlers, command, &on)) {
        return false;
    }
    if (!ale_command_handlers_request(handlers, &(ale_request_t){.kind = ALE_REQUEST_FREEZE, .on = on})) {
        return false;
    }
    handlers->map_frozen = on;
    return true;
}

static bool record(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    if (!handlers->exchange->recorder) {
        return ANSWER(handlers, false, "this robot records no flights");
    }
    return has_no_job(handlers) &&
           begin_job(handlers, command, ALE_JOB_RECORDING,
                     ale_recorder_ask(handlers->exchange->recorder, handlers->exchange->under_way));
}

typedef bool (*handler_t)(ale_command_handlers_t *handlers, const ale_command_t *command);

static const handler_t settings[ALE_SETTINGS] = {
    [ALE_SETTING_DRIVE_SPEED] = set_drive_speed,
    [ALE_SETTING_DRIVE_TURN] = set_drive_turn,
    [ALE_SETTING_PUBLISH_SCAN] = set_publish_scan,
    [ALE_SETTING_FREEZE_MAP] = set_freeze_map,
};

static bool set(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    return settings[ale_setting_of(command->arg[0])](handlers, command);
}

static const handler_t verbs[ALE_VERBS] = {
    [ALE_VERB_DRIVE] = drive,       [ALE_VERB_STOP] = stop,         [ALE_VERB_EXPLORE] = explore,
    [ALE_VERB_RESET] = reset,       [ALE_VERB_RELOCATE] = relocate, [ALE_VERB_SAVE_MAP] = save_map,
    [ALE_VERB_LOAD_MAP] = load_map, [ALE_VERB_RECORD] = record,     [ALE_VERB_SET] = set,
    [ALE_VERB_GOTO] = go_to,
};

bool ale_command_handlers_obey(ale_command_handlers_t *handlers, const ale_command_t *command)
{
    char error[ALE_VERB_ERROR];
    const int verb = ale_verb_of(command, error);
    return verb < 0 ? ANSWER(handlers, false, "%s", error) : verbs[verb](handlers, command);
}
