#include "guard.h"

#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

#ifndef PR_SET_SYSCALL_USER_DISPATCH
#define PR_SET_SYSCALL_USER_DISPATCH 59
#define PR_SYS_DISPATCH_ON 1
#endif

enum { LET_THROUGH = 0, STOP = 1 }; /* SYSCALL_DISPATCH_FILTER_ALLOW, _BLOCK */

static _Thread_local bool is_hard;
static _Thread_local int inside; /* calls of the emulation under way */
static _Thread_local volatile char dispatch;
static _Thread_local bool dispatched;

static bool watched(void)
{
    return is_hard && inside == 0;
}

/* Async-signal-safe, and makes no call that is watched. */
static void report(const char *what, long number)
{
    char line[120];
    is_hard = false;
    dispatch = LET_THROUGH;
    const int length =
        number < 0 ? snprintf(line, sizeof line, "RTAI emulation: a hard task %s\n", what)
                   : snprintf(line, sizeof line, "RTAI emulation: a hard task %s %ld\n", what, number);
    if (write(STDERR_FILENO, line, (size_t)length) >= 0) {
        abort();
    }
    _exit(1);
}

static void on_system_call(int signal, siginfo_t *info, void *context)
{
    (void)signal;
    (void)context;
    dispatch = LET_THROUGH;
    report("makes the system call", info->si_syscall);
}

/* The kernel stops system calls of this thread while `dispatch` says so (Linux 5.11). */
static void begin_dispatch(void)
{
    struct sigaction action = {.sa_sigaction = on_system_call, .sa_flags = SA_SIGINFO};
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGSYS);
    sigaction(SIGSYS, &action, NULL);
    pthread_sigmask(SIG_UNBLOCK, &only, NULL);
    if (prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, 0, 0, &dispatch) < 0) {
        fputs("RTAI emulation: this kernel cannot stop system calls: they are not watched\n", stderr);
    }
    dispatched = true;
}

void guard_set_hard(bool hard)
{
    if (hard && !dispatched) {
        begin_dispatch();
    }
    is_hard = hard;
}

void guard_leave(void)
{
    inside++;
    dispatch = LET_THROUGH;
}

void guard_return(void)
{
    inside--;
    if (watched()) {
        dispatch = STOP;
    }
}

/* What stands in for the C library's own; the program's symbols come first. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void __libc_free(void *memory);

static void no_allocation(void)
{
    if (watched()) {
        report("allocates or frees memory", -1);
    }
}

void *malloc(size_t size)
{
    no_allocation();
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    no_allocation();
    return __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    no_allocation();
    return __libc_realloc(memory, size);
}

void free(void *memory)
{
    no_allocation();
    __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t *mutex)
{
    static int (*real)(pthread_mutex_t *);
    if (watched()) {
        report("takes a lock", -1);
    }
    if (!real) {
        *(void **)&real = dlsym(RTLD_NEXT, "pthread_mutex_lock");
    }
    return real(mutex);
}

int clock_gettime(clockid_t clock, struct timespec *time)
{
    static int (*real)(clockid_t, struct timespec *);
    if (watched()) {
        report("asks Linux for the time", -1);
    }
    if (!real) {
        *(void **)&real = dlsym(RTLD_NEXT, "clock_gettime");
    }
    return real(clock, time);
}
