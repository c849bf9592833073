/* The line to a scanner that is opened again and again: candidates, pauses, time, bytes through the tap. For
 * families in drivers/scanner. One owner thread. */
#ifndef ALE_SCANNER_CONNECTION_H
#define ALE_SCANNER_CONNECTION_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/scanner_types.h"
#include "serial/port.h"
#include "serial/port_candidates.h"

enum { ALE_CONNECTION_BYTES = 4096 };

/* Fields are private, but for reading. */
typedef struct {
    const ale_scanner_config_t *config;
    ale_port_t *port; /* NULL: closed */
    char candidates[ALE_PORT_CANDIDATES][ALE_PORT_PATH];
    uint32_t candidate_count;
    uint32_t candidate; /* next one to try */
    int64_t open_at_us;
    uint32_t failures;
    uint8_t bytes[ALE_CONNECTION_BYTES]; /* as read */
    uint32_t count;
    uint32_t used; /* of them, by the owner */
    int64_t read_us;
} ale_connection_t;

/* config must outlive the connection. */
void ale_connection_init(ale_connection_t *connection, const ale_scanner_config_t *config);

/* The clock of the config, microseconds. */
int64_t ale_connection_now_us(const ale_connection_t *connection);

/* The moment in so many milliseconds of that clock, but not in less than the 100 ms that this computer's
 * scheduler may take, however fast the clock runs. */
int64_t ale_connection_deadline_us(const ale_connection_t *connection, int32_t ms);

/* Of a closed one: waits until it is time to open, at most step_ms, and opens when it is. True: opened, or
 * failed to, and then words says why; false: not yet. path: of the port that was tried. */
bool ale_connection_open(ale_connection_t *connection, int32_t baud, char path[128], char words[168]);

/* Closes the port, at once; it may be opened again after a pause that grows with every failure. */
void ale_connection_close(ale_connection_t *connection);

/* What is connected works: the next pause is short again. */
void ale_connection_proved(ale_connection_t *connection);

/* Waits until a moment, at most step_ms, for bytes, and reads them: bytes[0..count) are new and none is used.
 * ALE_PORT_OK, or a negative status: close it. */
int ale_connection_receive(ale_connection_t *connection, int64_t until_us);

/* Uses the next bytes: they pass the tap. At most what is there. */
void ale_connection_use(ale_connection_t *connection, uint32_t count);

/* Sends all of the bytes, through the tap. ALE_PORT_OK, or a negative status: close it. */
int ale_connection_send(ale_connection_t *connection, const uint8_t *bytes, uint32_t count);

#endif
