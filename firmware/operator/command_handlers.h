/* What each verb of a command does. For commands.c alone. */
#ifndef ALE_FIRMWARE_OPERATOR_COMMAND_HANDLERS_H
#define ALE_FIRMWARE_OPERATOR_COMMAND_HANDLERS_H

#include "operator/commands.h"
#include "operator/drive.h"
#include "operator/drive_arbiter.h"

struct ale_commands {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_map_storage_t *storage;
    ale_verifier_t verifier;
    ale_drive_arbiter_t arbiter;
    ale_drive_orders_t orders;
    const ale_map_t *newest_map; /* while a command is obeyed */
    bool map_frozen;
    bool publish_scan; /* as set by the configuration and by operators */
    int32_t drive_um_s;
    int32_t drive_urad_s;
    int64_t now_us; /* of the command that is obeyed */
    bool news;
    bool explored;  /* was on when last looked at */
    bool job_waits; /* a map is being saved or loaded: */
    char job_operator[ALE_NAME_BYTES];
    int64_t job_counter;
    ale_request_t job_request;          /* what the estimate task is asked for once it is loaded */
    uint64_t refused;                   /* genuine commands that were not obeyed */
    char operator_name[ALE_NAME_BYTES]; /* of the answer */
    int64_t counter;
    bool obeyed;
    char result[ALE_ANSWER_BYTES];
};

/* Does what the command says and writes the answer: true obeyed, false refused. A save or load that has
 * begun sets job_waits: its answer comes later. */
bool ale_command_handlers_obey(ale_commands_t *commands, const ale_command_t *command);

/* False, and the answer is written: the estimate task has not taken the last ones yet. */
bool ale_command_handlers_request(ale_commands_t *commands, const ale_request_t *request);

#endif
