/* Decides which operator drives: one at a time, for as long as he keeps asking.
 *
 *   drive ──► refused while another operator drives, or while asked for without a pause since a stop
 *        └──► granted: velocity request, valid for ALE_DEAD_MAN_US; no other operator for ALE_ARBITER_HOLD_US
 *   stop  ──► no request, nobody drives; driving begins again when nobody has asked for ALE_DEAD_MAN_US
 *
 * So a stop is stronger than a stick that is still held, wherever it is held. Pure; times are of the clock
 * inside (monotonic). One owner: the telemetry thread. */
#ifndef ALE_FIRMWARE_OPERATOR_DRIVE_ARBITER_H
#define ALE_FIRMWARE_OPERATOR_DRIVE_ARBITER_H

#include <stdbool.h>
#include <stdint.h>

#include "command/command.h"
#include "exchange/thread_messages.h"

enum { ALE_DEAD_MAN_US = 300000, ALE_ARBITER_HOLD_US = 2000000 };

typedef enum { ALE_ARBITER_GRANTED, ALE_ARBITER_TAKEN, ALE_ARBITER_STOPPED } ale_arbiter_answer_t;

typedef struct {
    char holder[ALE_NAME_BYTES];
    int64_t held_until_us;
    ale_velocity_request_t request;
    bool stopped;
    int64_t asked_us;  /* last time that anybody wanted to drive, or the stop */
} ale_drive_arbiter_t; /* all zero: nobody drives */

/* An operator asks to drive. GRANTED: the velocity request is set. TAKEN: another operator drives. STOPPED:
 * nobody has paused for ALE_DEAD_MAN_US since the stop. */
ale_arbiter_answer_t ale_drive_arbiter_drive(ale_drive_arbiter_t *arbiter, const char *name, int32_t v_um_s,
                                             int32_t w_urad_s, int64_t now_us);

void ale_drive_arbiter_stop(ale_drive_arbiter_t *arbiter, int64_t now_us);

/* The operator who drives; empty: nobody. */
const char *ale_drive_arbiter_holder(const ale_drive_arbiter_t *arbiter, int64_t now_us);

#endif
