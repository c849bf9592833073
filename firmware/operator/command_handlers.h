/* What each verb of a command does: one handler a verb, in one table. For commands.c alone, which verifies
 * the command before and tells the answer after. */
#ifndef ALE_FIRMWARE_OPERATOR_COMMAND_HANDLERS_H
#define ALE_FIRMWARE_OPERATOR_COMMAND_HANDLERS_H

#include <stdbool.h>
#include <stdint.h>

#include "command/command.h"
#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/report.h"
#include "mapping/map_storage.h"
#include "operator/drive_arbiter.h"

/* What takes its time and is answered when it is done: a map saved or loaded, a flight recorded, a way
 * planned. */
typedef enum { ALE_JOB_NONE, ALE_JOB_MAP, ALE_JOB_RECORDING, ALE_JOB_GOAL } ale_job_t;

enum { ALE_GOAL_PATIENCE_US = 3000000 }; /* a way is planned with the next scan, if one comes */

/* What the handlers act on. */
typedef struct {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_map_storage_t *storage;
    ale_drive_arbiter_t arbiter;
    ale_drive_orders_t orders;
    const ale_map_t *newest_map; /* while a command is obeyed */
    bool map_frozen;
    bool publish_scan; /* as set by the configuration and by operators */
    int32_t drive_um_s;
    int32_t drive_urad_s;
    int64_t now_us; /* of the command that is obeyed */
    bool news;
    ale_job_t job; /* under way: */
    char job_operator[ALE_NAME_BYTES];
    int64_t job_counter;
    int64_t job_begun_us;
    ale_request_t job_request; /* what the estimate task is asked for once it is loaded */
    char result[ALE_ANSWER_BYTES];
} ale_command_handlers_t;

/* config, exchange and storage must outlive the handlers. */
void ale_command_handlers_init(ale_command_handlers_t *handlers, const ale_config_t *config,
                               ale_exchange_t *exchange, ale_map_storage_t *storage);

/* Does what the command says and writes the answer to result: true obeyed, false refused. A job that has
 * begun sets job: its answer comes later. */
bool ale_command_handlers_obey(ale_command_handlers_t *handlers, const ale_command_t *command);

/* Hands a request to the estimate task. False, and the answer is written: it has not taken the last ones yet.
 */
bool ale_command_handlers_request(ale_command_handlers_t *handlers, const ale_request_t *request);

#endif
