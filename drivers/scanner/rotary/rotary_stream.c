#include "scanner/rotary/rotary_stream.h"

#include "base/fixed.h"

enum { SILENT_TURNS = 5, LEAST_SILENCE_MS = 400, BITS_A_BYTE = 10 };

void ale_rotary_stream_init(ale_rotary_stream_t *stream, bool clockwise, bool reversed)
{
    stream->clock = (ale_rotary_clock_t){0};
    ale_turns_init(&stream->turns, clockwise, reversed);
}

void ale_rotary_stream_begin(ale_rotary_stream_t *stream)
{
    ale_turns_begin(&stream->turns);
    stream->clock = (ale_rotary_clock_t){.jumps = stream->clock.jumps};
}

/* The last point of the packet was measured when the packet began its way on the line. */
bool ale_rotary_stream_take(ale_rotary_stream_t *stream, const ale_rotary_packet_t *packet, int64_t read_us,
                            int32_t baud)
{
    const uint64_t jumps = stream->clock.jumps;
    const int64_t line_us = (int64_t)packet->line_bytes * BITS_A_BYTE * 1000000 / baud;
    const int64_t known_us =
        ale_rotary_clock_take(&stream->clock, packet->sensor_us + packet->behind_us, read_us);
    const bool goes_on = stream->clock.jumps == jumps;
    if (!goes_on) {
        ale_turns_begin(&stream->turns);
    }
    ale_turns_take(&stream->turns, packet, known_us - packet->behind_us - line_us);
    return goes_on;
}

int64_t ale_rotary_stream_silence_ms(const ale_rotary_stream_t *stream)
{
    const int64_t silence_us = (int64_t)stream->turns.period_us * SILENT_TURNS;
    return ale_clamp64(silence_us / 1000, LEAST_SILENCE_MS, INT32_MAX);
}
