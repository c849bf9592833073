/* The motor controller's side of the serial line: lines of text with a checksum. Nothing but C.
 *
 *   ale_motor_line_t line = {0};
 *   if (ale_motor_byte(&line, byte, millis())) ...                 (for each byte; true: a set point was
 * taken) ale_motor_line_set_point(&line, millis(), &v_mm_s, &w_mrad_s); (zero after 300 ms without one)
 *
 * A line reaches whoever holds the wire, so it carries no key; its counter tells what was said twice. */
#ifndef ALE_MOTOR_LINE_RECEIVER_H
#define ALE_MOTOR_LINE_RECEIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ALE_MOTOR_LINE = 64, ALE_MOTOR_LINE_DEAD_MAN_MS = 300 };

typedef struct {
    char text[ALE_MOTOR_LINE];
    uint8_t length;
    bool moves;
    uint32_t
        counter; /* of the last one taken; another one is new, also a lower one: the robot started again */
    uint32_t taken_ms;
    int32_t v_mm_s, w_mrad_s;
} ale_motor_line_t;

/* The next byte of the line. */
bool ale_motor_byte(ale_motor_line_t *line, char byte, uint32_t now_ms);

void ale_motor_line_set_point(ale_motor_line_t *line, uint32_t now_ms, int32_t *v_mm_s, int32_t *w_mrad_s);

/* CRC-16/CCITT-FALSE: polynomial 0x1021, begins with 0xFFFF. */
uint16_t ale_motor_crc(const char *text, size_t count);

#ifdef __cplusplus
}
#endif

#endif
