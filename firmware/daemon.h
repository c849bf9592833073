/* The running firmware: its threads, what passes between them, and their order of start and end. */
#ifndef ALE_FIRMWARE_DAEMON_H
#define ALE_FIRMWARE_DAEMON_H

#include "config/options.h"

typedef struct ale_daemon ale_daemon_t;

/* Starts everything; all signals should be blocked already. NULL: *exit_code is 1 (failed) or 2 (this
 * configuration cannot run), one line on stderr has said why. options must outlive the daemon. */
ale_daemon_t *ale_daemon_start(const ale_options_t *options, int *exit_code);

/* Ends all threads in the order of the data, so that the last scans are still answered. */
void ale_daemon_stop(ale_daemon_t *daemon);

/* Asks for a flight recording, if the configuration names a folder for them. Returns at once. */
void ale_daemon_record(ale_daemon_t *daemon);

#endif
