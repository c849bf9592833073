/* What a test may do to the emulation, and ask it. Any thread. */
#ifndef ALE_TESTS_RTAI_EMULATION_H
#define ALE_TESTS_RTAI_EMULATION_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* From now on there is no RTAI in this kernel. */
void rtai_emulated_absent(bool absent);

/* The counts in the scheduler's file: hard tasks handed to Linux. */
void rtai_emulated_forced(int traps, int calls);

/* The timer as another program has started it. */
void rtai_emulated_timer(bool running);

/* The next change to hard finds a signal pending and is put off by one call. */
void rtai_emulated_signal(void);

/* The next task is refused. */
void rtai_emulated_refuse(void);

#ifdef __cplusplus
}
#endif

#endif
