/* Commands of operators: checked, obeyed or refused, answered. drivers/command/README.md lists the verbs.
 *
 *   commands = ale_commands_create(config, &keys, boot, exchange, storage);
 *   ale_commands_take(commands, bytes, count, newest_map);     (for every ALE_COMMAND)
 *   ale_commands_work(commands);                               (often: answers what took its time)
 *   if (ale_commands_news(commands)) ... ale_commands_report(commands, &report.operation), ALE_STATUS at once
 *
 * Telemetry thread only. */
#ifndef ALE_FIRMWARE_OPERATOR_COMMANDS_H
#define ALE_FIRMWARE_OPERATOR_COMMANDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/verify.h"
#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/report.h"
#include "mapping/map_storage.h"

typedef struct ale_commands ale_commands_t;

/* boot: the nonce of this start, as in ALE_STATUS. keys may be none: then nobody is obeyed. config, exchange
 * and storage must outlive it. NULL: out of memory. */
ale_commands_t *ale_commands_create(const ale_config_t *config, const ale_keys_t *keys, int64_t boot,
                                    ale_exchange_t *exchange, ale_map_storage_t *storage);
void ale_commands_destroy(ale_commands_t *commands);

/* Any bytes. newest_map: what save_map saves; NULL: none yet. Whether it was a genuine command; what is none
 * is counted and has no answer. */
bool ale_commands_take(ale_commands_t *commands, const uint8_t *bytes, size_t count,
                       const ale_map_t *newest_map);

void ale_commands_work(ale_commands_t *commands);

/* True when operators should hear something at once; once for each news. */
bool ale_commands_news(ale_commands_t *commands);

void ale_commands_report(const ale_commands_t *commands, ale_operation_report_t *report);

/* Appends the counters of what was obeyed and refused, and why. */
void ale_commands_counters(const ale_commands_t *commands, ale_status_report_t *report);

/* Whether scans are published: the configuration says, until an operator does. */
bool ale_commands_publish_scan(const ale_commands_t *commands);

#endif
