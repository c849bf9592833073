/* Who drives, and what he wants: one operator at a time, for so long as he keeps asking.
 *
 *   drive ──► refused while somebody else drives, or while asked for without a pause since a stop
 *        └──► wish, valid for ALE_DEAD_MAN_US; the desk is his for ALE_DESK_HOLD_US
 *   stop  ──► no wish, nobody's desk; driving begins again after ALE_DEAD_MAN_US in which nobody asked
 *
 * So a stop is stronger than a stick that is still held, wherever it is held. Pure; times are of the clock
 * inside (monotonic). One owner: the telemetry thread. */
#ifndef ALE_FIRMWARE_OPERATOR_DRIVE_ARBITER_H
#define ALE_FIRMWARE_OPERATOR_DRIVE_ARBITER_H

#include <stdbool.h>
#include <stdint.h>

#include "command/command.h"

enum { ALE_DEAD_MAN_US = 300000, ALE_DESK_HOLD_US = 2000000 };

/* A velocity that somebody wants, until a moment. All zero: none. */
typedef struct {
    int32_t v_um_s;
    int32_t w_urad_s;
    int64_t valid_until_us;
} ale_wish_t;

typedef enum { ALE_DESK_HIS, ALE_DESK_TAKEN, ALE_DESK_STOPPED } ale_desk_answer_t;

typedef struct {
    char holder[ALE_NAME_BYTES];
    int64_t held_until_us;
    ale_wish_t wish;
    bool stopped;
    int64_t asked_us; /* last time that anybody wanted to drive, or the stop */
} ale_drive_desk_t;   /* all zero: nobody drives */

/* An operator wants to drive. ALE_DESK_HIS: the wish is set. */
ale_desk_answer_t ale_drive_desk_drive(ale_drive_desk_t *desk, const char *name, int32_t v_um_s,
                                       int32_t w_urad_s, int64_t now_us);

void ale_drive_desk_stop(ale_drive_desk_t *desk, int64_t now_us);

/* Who holds the desk; empty: nobody. */
const char *ale_drive_desk_holder(const ale_drive_desk_t *desk, int64_t now_us);

#endif
