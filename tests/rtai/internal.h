/* What the parts of the emulation share. */
#ifndef ALE_TESTS_RTAI_INTERNAL_H
#define ALE_TESTS_RTAI_INTERNAL_H

#include <pthread.h>
#include <stdbool.h>
#include <time.h>

#include "include/rtai_lxrt.h"

enum { OBJECTS = 64 };

/* One lock for all of RTAI. */
extern pthread_mutex_t rtai_lock;

/* Around every call. As in RTAI, a task that was pushed to soft goes back to hard by it. */
void rtai_enter(void);
void rtai_leave(void);

/* One name space for all kinds of objects: true when the name was free. 0 is no name. Under the lock. */
bool rtai_register(unsigned long name, void *handle);
void rtai_unregister(void *handle);

/* One that nobody has had. Under the lock. */
unsigned long rtai_next_name(void);

/* An address in a kernel that stands for slot number k of a kind. */
void *rtai_handle(unsigned kind, int slot);
/* The slot of a handle; the process ends when it is none of that kind. */
int rtai_slot(unsigned kind, const void *handle);

/* A moment of RTAI's clock as one of CLOCK_MONOTONIC. Ends the process when RTAI's timer does not run: nobody
 * would ever come back from such a wait. */
struct timespec rtai_wake_time(RTIME counts);

void rtai_sleep_until(RTIME counts);

/* Ends the process with one line. */
_Noreturn void rtai_misuse(const char *what);

#endif
