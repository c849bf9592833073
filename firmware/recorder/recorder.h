/* The flight recorder: the last minutes of raw bytes, odometry, decisions and stage times in memory of fixed
 * size, written to disk on a fault, a missed deadline or a command.
 *
 *   acquire ─── bytes, scans ───────► queue ─┐
 *                                            ├─► recorder thread: chunks in one order ─► flight ring
 *   telemetry ─ odometry, results ──► queue ─┘   (flight_order.h)            └─► flight-TIME-REASON.scip
 *
 * The order is that of the estimate task: odometry lies before the scan that knew it, so that ale-replay
 * comes to the same poses. Writers never wait: what finds its queue full is refused and counted. All
 * functions take NULL for a recorder, and then do nothing. */
#ifndef ALE_FIRMWARE_RECORDER_RECORDER_H
#define ALE_FIRMWARE_RECORDER_RECORDER_H

#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/report.h"
#include "store/recording.h"

/* Files kept on disk: recordings of faults, of missed deadlines, and asked ones. */
enum { ALE_FLIGHTS_OF_FAULTS = 10, ALE_FLIGHTS_LATE = 5, ALE_FLIGHTS_ASKED = 5 };

typedef struct ale_recorder ale_recorder_t;

typedef enum { ALE_RECORD_COMMAND, ALE_RECORD_FAULT, ALE_RECORD_DEADLINE } ale_record_reason_t;

/* What came of a recording that was asked for: in words, "not recorded: No space left on device". */
typedef struct {
    bool fine;
    char text[ALE_ANSWER_BYTES];
} ale_record_outcome_t;

/* Starts the recorder's own thread, without a real-time priority. config must outlive it. NULL: out of
 * memory or threads. */
ale_recorder_t *ale_recorder_start(const ale_config_t *config);

/* Writes what was triggered and not yet written. The writers have stopped. */
void ale_recorder_stop(ale_recorder_t *recorder);

/* Any thread, never blocks: a recording is wanted. A command is answered at once; for the others the
 * recording goes on a few seconds, so that it shows what came of it, and then none is written of itself for a
 * minute and more (flight_pause.h). */
void ale_recorder_trigger(ale_recorder_t *recorder, ale_record_reason_t reason);

/* Telemetry thread: as a command triggers, and what came of it is wanted. The descriptor `wake` is posted
 * when it can be had. False: the last one that was asked for has not been told yet. */
bool ale_recorder_ask(ale_recorder_t *recorder, int wake);

/* Telemetry thread. True once for each that was asked for, when it is written or could not be. */
bool ale_recorder_done(ale_recorder_t *recorder, ale_record_outcome_t *outcome);

/* Acquire thread: the preset of the noise from the next scan on; recordings tell it in their configuration.
 */
void ale_recorder_preset(ale_recorder_t *recorder, const char name[ALE_PRESET_NAME]);

/* Acquire thread. Bytes as they pass; then the scan, lost or not, that they made: `number` counts all that
 * were handed to the estimate task. */
void ale_recorder_bytes(ale_recorder_t *recorder, bool sent, const uint8_t *bytes, uint32_t count,
                        int64_t now_us);
void ale_recorder_scan(ale_recorder_t *recorder, uint32_t number);

/* Telemetry thread. A sample of odometry handed to the estimate task (`number` counts those); an operator's
 * command; a correction that the estimate task took before the scan of the result that is told next; the
 * result itself. */
void ale_recorder_odometry(ale_recorder_t *recorder, uint32_t number, const ale_odometry_t *sample);
void ale_recorder_command(ale_recorder_t *recorder, int64_t now_us, const char *text);
void ale_recorder_correction(ale_recorder_t *recorder, int64_t now_us, uint32_t scan, ale_pose_t pose);
void ale_recorder_result(ale_recorder_t *recorder, const ale_result_t *result);

/* Any thread: recordings written, and what was refused because a queue was full. */
uint32_t ale_recorder_written(const ale_recorder_t *recorder);
uint32_t ale_recorder_refused(const ale_recorder_t *recorder);

#endif
