/* Words for people from a thread that must not wait: what is written on may be a terminal, a journal or a
 * busy disk, and hold its writer up for seconds.
 *
 *   telemetry ── ale_speaker_say ──► ring ──► its thread, without priority ──► out */
#ifndef ALE_FIRMWARE_SYSTEM_ASYNC_LOGGER_H
#define ALE_FIRMWARE_SYSTEM_ASYNC_LOGGER_H

#include <stdint.h>
#include <stdio.h>

typedef struct ale_speaker ale_speaker_t;

enum { ALE_SPEAKER_LINE = 320 };

/* out must outlive it. NULL: out of memory, descriptors or threads. */
ale_speaker_t *ale_speaker_start(FILE *out);

/* Waits until all is written. NULL: nothing. */
void ale_speaker_stop(ale_speaker_t *speaker);

/* From one thread; copies and never blocks. Goes out as a line of its own after the program's name; cut to
 * ALE_SPEAKER_LINE - 1 bytes, left out where 16 lines wait already: how many were is a line behind those. */
void ale_speaker_say(ale_speaker_t *speaker, const char *words);

/* Any thread: lines left out since the start. */
uint32_t ale_speaker_left_out(const ale_speaker_t *speaker);

#endif
