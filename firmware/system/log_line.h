/* The form of all lines that are logged for people: the program's name, the time where what takes the line
 * keeps none, and the words. */
#ifndef ALE_FIRMWARE_SYSTEM_LOG_LINE_H
#define ALE_FIRMWARE_SYSTEM_LOG_LINE_H

#include <stdbool.h>
#include <stdio.h>
#include <time.h>

/* Whether standard error keeps no time of its own, as a journal does. */
bool ale_log_wants_time(void);

/* As "ale-slamd: 2026-11-24 03:02:11 WORDS", by the wall clock. */
void ale_log_write(FILE *out, bool with_time, time_t logged_s, const char *words);

/* On standard error, of now: from a thread that may wait for whoever reads there. Cut to 1000 bytes. */
void ale_log_line(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
