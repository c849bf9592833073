/* From packets of a rotary scanner to scans in host time: the clock and the turns together, as the device and
 * a reader of recordings use them.
 *
 *   ale_rotary_stream_begin(&stream);                               when the stream is (re)started
 *   ale_rotary_stream_take(&stream, &packet, read_us, baud);        for each packet of points
 *   while ((kind = ale_turns_next(&stream.turns, &scan)) != ALE_SCANNER_IDLE) ...
 *
 * Pure: the same packets, read at the same times, give the same scans. */
#ifndef ALE_SCANNER_ROTARY_STREAM_H
#define ALE_SCANNER_ROTARY_STREAM_H

#include "scanner/rotary/rotary_clock.h"
#include "scanner/rotary/turns.h"

/* Fields are private, but for reading. */
typedef struct {
    ale_rotary_clock_t clock;
    ale_turns_t turns;
} ale_rotary_stream_t;

void ale_rotary_stream_init(ale_rotary_stream_t *stream, bool clockwise, bool reversed);

/* The turn under way was not seen whole, and the sensor's clock is another. */
void ale_rotary_stream_begin(ale_rotary_stream_t *stream);

/* read_us: host time at which its last byte was read; baud: bit/s of the line that it was on. False: the
 * sensor's clock jumped, and the turn under way is lost. */
bool ale_rotary_stream_take(ale_rotary_stream_t *stream, const ale_rotary_packet_t *packet, int64_t read_us,
                            int32_t baud);

/* Time without a scan after which the sensor counts as silent. */
int64_t ale_rotary_stream_silence_ms(const ale_rotary_stream_t *stream);

#endif
