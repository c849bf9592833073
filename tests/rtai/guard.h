/* Watches threads that are hard: one that allocates, takes a lock, asks Linux for the time or makes a system
 * call ends the process with one line that says which (abort). Calls of the emulation itself are let through.
 */
#ifndef ALE_TESTS_RTAI_GUARD_H
#define ALE_TESTS_RTAI_GUARD_H

#include <stdbool.h>

/* The calling thread becomes hard or soft. */
void guard_set_hard(bool hard);

/* Around everything the emulation does for a task; they nest. */
void guard_leave(void);
void guard_return(void);

#endif
