/* The robot's side of set points for a motor controller: as a message with a tag, and as a line of text.
 * Pure functions on bytes. README.md says how both look and what the other side checks. */
#ifndef ALE_MOTOR_SET_POINT_H
#define ALE_MOTOR_SET_POINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/keys.h"
#include "motor/receiver.h"

typedef struct {
    int64_t utime;
    int64_t boot;    /* of this start of the robot */
    int64_t nonce;   /* of the motor side's start; 0: not heard of yet */
    int64_t counter; /* from 1 */
    int32_t v_um_s;
    int32_t w_urad_s;
} ale_keyed_set_point_t;

/* The bytes of an ALE_DRIVE_KEYED. */
void ale_set_point_message(const ale_keyed_set_point_t *point, const ale_drive_key_t *key,
                           uint8_t bytes[ALE_MOTOR_MESSAGE]);

/* Any bytes. Whether they are an ALE_DRIVE_READY of who has the key, for this start of the robot: then *nonce
 * is set. */
bool ale_set_point_ready(const uint8_t *bytes, size_t count, const ale_drive_key_t *key, int64_t boot,
                         int64_t *nonce);

enum { ALE_SET_POINT_LINE = 64 };

/* "$ALE,17,250,-100*5A7C\r\n": counter, mm/s forward, mrad/s counter-clockwise, CRC-16/CCITT of what stands
 * between $ and *. Its length. */
size_t ale_set_point_line(uint32_t counter, int32_t v_um_s, int32_t w_urad_s, char line[ALE_SET_POINT_LINE]);

#endif
