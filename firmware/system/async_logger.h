/* Logs lines for people from a thread that must not wait: a terminal, a journal or a busy disk may hold its
 * writer up for seconds.
 *
 *   telemetry ── ale_logger_log ──► ring ──► its thread, without priority ──► out */
#ifndef ALE_FIRMWARE_SYSTEM_ASYNC_LOGGER_H
#define ALE_FIRMWARE_SYSTEM_ASYNC_LOGGER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct ale_logger ale_logger_t;

enum { ALE_LOGGER_LINE = 320 };

/* out must outlive it; with_time: every line tells when it was logged, by the wall clock ("2026-11-24
 * 03:02:11"), for what keeps no time itself. NULL: out of memory, descriptors or threads. */
ale_logger_t *ale_logger_start(FILE *out, bool with_time);

/* Waits until all is written. NULL: nothing. */
void ale_logger_stop(ale_logger_t *logger);

/* From one thread; copies and never blocks. Goes out as a line of its own after the program's name, cut to
 * ALE_LOGGER_LINE - 1 bytes. It is dropped when 16 lines wait already; a line behind those says how many
 * were. */
void ale_logger_log(ale_logger_t *logger, const char *words);

/* Any thread: lines dropped since the start. */
uint32_t ale_logger_dropped(const ale_logger_t *logger);

#endif
