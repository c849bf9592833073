/* The real-time port over RTAI/LXRT: the only file that knows RTAI.
 *
 *   main          soft LXRT task: starts RTAI's timer if nobody else runs it, makes semaphores
 *   ALE_RT_HARD   LXRT task made hard: RTAI schedules it, Linux cannot hold it up
 *   ALE_RT_SOFT   LXRT task that stays soft: may use Linux and signal the hard one
 *   ALE_RT_ORDINARY, ALE_RT_BACKGROUND  threads of Linux that RTAI does not know
 *
 * Traps that shape it: RTAI binds each of its tasks to one processor, and threads inherit that; a handle is
 * an address in the kernel and never looked into; errors are big positive numbers; the timer belongs to all
 * programs of the machine; a hard task that calls Linux is handed over to it and nothing in the return values
 * tells, only RTAI's own count of such cases does. */
#include "realtime/rt.h"

#include <rtai_lxrt.h>
#include <rtai_sem.h>

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "realtime/findings.h"
#include "realtime/machine.h"
#include "realtime/memory.h"
#include "serial/port.h"
#include "serial/port_backend.h"

/* A release of RTAI may be built without its serial driver, the newest have none. */
#if __has_include(<rtai_serial.h>)
#include <rtai_serial.h>
#endif

/* An emulation of RTAI says where its own lies. */
#ifndef ALE_RTAI_SCHEDULER
#define ALE_RTAI_SCHEDULER "/proc/rtai/scheduler"
#endif

/* RTAI's priorities count down, those of SCHED_FIFO up; LXRT gives its soft tasks the latter as 99 minus the
 * former.
 */
enum { LINUX_PRIORITY_MAX = 99, ANY_CPU = 0xFF, SAME_CPU = 0, MASK_CPUS = 31 };
enum { TOUCHED_BYTES = ALE_RT_STACK_BYTES - 64 * 1024 }; /* less what is in use above */

struct ale_rt_task {
    long thread;
    ale_rt_task_config_t config;
    atomic_bool stopping;
    sem_t ready;  /* entered, or refused */
    bool refused; /* RTAI gives no task: names, rights or memory have run out */
};

struct ale_rt_release {
    SEM *semaphore;
};

static struct {
    ale_rt_config_t config;
    RT_TASK *main_task;
    cpu_set_t cpus; /* of the program, before RTAI bound main to one of them */
    bool memory_locked;
    bool timer_is_ours;
    atomic_bool hard;
    unsigned long forced_before; /* transitions counted by RTAI before there was a hard task */
} state;

int64_t ale_rt_now_ns(void)
{
    return rt_get_time_ns();
}

/* How often hard tasks were handed to Linux for a system call or a fault, of all programs, since RTAI was
 * loaded. */
static unsigned long forced_transitions(void)
{
    char line[256];
    unsigned long traps = 0;
    unsigned long calls = 0;
    FILE *file = fopen(ALE_RTAI_SCHEDULER, "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *counts = strstr(line, "traps ");
        if (counts && sscanf(counts, "traps %lu, syscalls %lu", &traps, &calls) == 2) {
            break;
        }
    }
    if (file) {
        fclose(file);
    }
    return traps + calls;
}

static int rtai_priority(ale_rt_kind_t kind)
{
    return LINUX_PRIORITY_MAX - state.config.priority + (kind == ALE_RT_HARD ? 0 : 1);
}

static bool has_cpu_of_its_own(void)
{
    return state.config.cpu >= 0 && state.config.cpu < MASK_CPUS &&
           CPU_ISSET((size_t)state.config.cpu, &state.cpus);
}

/* RTAI takes the processor with the fewest of its tasks among those of the mask. */
static int cpu_mask(ale_rt_kind_t kind)
{
    if (!has_cpu_of_its_own()) {
        return kind == ALE_RT_HARD ? ANY_CPU : SAME_CPU;
    }
    int others = SAME_CPU;
    for (int cpu = 0; cpu < MASK_CPUS; cpu++) {
        others |= CPU_ISSET((size_t)cpu, &state.cpus) && cpu != state.config.cpu ? 1 << cpu : 0;
    }
    return kind == ALE_RT_HARD ? 1 << state.config.cpu : others;
}

#ifdef RT_SP_NO_HAND_SHAKE
/* 16550 ports by RTAI's own driver, "rtai:0" being the first; Linux's driver must have let go of it. Its
 * calls tell how many bytes are left, and its buffer holds less than one answer of the scanner: the reader
 * looks every millisecond. */
#define SERIAL_LOOK_NS 1000000

static unsigned tty_of(const ale_port_t *port)
{
    return (unsigned)(uintptr_t)port->handle;
}

static int serial_set_up(unsigned tty, int32_t baud)
{
    switch (rt_spopen(tty, (unsigned)baud, 8, 1, RT_SP_PARITY_NONE, RT_SP_NO_HAND_SHAKE, RT_SP_FIFO_SIZE_8)) {
    case 0:
        return ALE_PORT_OK;
    case -EADDRINUSE:
        return ALE_PORT_BUSY;
    case -EINVAL:
        return ALE_PORT_BAUD;
    default:
        return ALE_PORT_ABSENT;
    }
}

static int serial_open(ale_port_t *port, const char *number, int32_t baud)
{
    char *end = NULL;
    const unsigned long tty = strtoul(number, &end, 10);
    if (end == number || *end != '\0' || tty > INT_MAX) {
        return ALE_PORT_ABSENT;
    }
    port->handle = (void *)(uintptr_t)tty;
    return serial_set_up((unsigned)tty, baud);
}

static int serial_set_baud(ale_port_t *port, int32_t baud)
{
    rt_spclose(tty_of(port));
    return serial_set_up(tty_of(port), baud);
}

static int moved(int count, int left)
{
    return left < 0 || left > count ? ALE_PORT_GONE : count - left;
}

static int serial_read(ale_port_t *port, uint8_t *bytes, size_t capacity)
{
    const int count = capacity < INT_MAX ? (int)capacity : INT_MAX;
    return moved(count, rt_spread(tty_of(port), (char *)bytes, count));
}

static int serial_write(ale_port_t *port, const uint8_t *bytes, size_t size)
{
    const int count = size < INT_MAX ? (int)size : INT_MAX;
    return moved(count, rt_spwrite(tty_of(port), (char *)bytes, count));
}

static int serial_wait(ale_port_t *port, short events, int32_t timeout_ms)
{
    const int64_t until_ns = ale_rt_now_ns() + (int64_t)timeout_ms * 1000000;
    for (;;) {
        const int readable = rt_spget_rxavbs(tty_of(port)) > 0 ? POLLIN : 0;
        const int writable = rt_spget_txfrbs(tty_of(port)) > 0 ? POLLOUT : 0;
        const int came = (readable | writable) & events;
        if (came != 0 || ale_rt_now_ns() >= until_ns) {
            return came;
        }
        rt_sleep(nano2count(SERIAL_LOOK_NS));
    }
}

static void serial_close(ale_port_t *port)
{
    rt_spclose(tty_of(port));
}

static void offer_serial_driver(void)
{
    static const ale_port_backend_t driver = {.open = serial_open,
                                              .set_baud = serial_set_baud,
                                              .read = serial_read,
                                              .write = serial_write,
                                              .close = serial_close,
                                              .wait = serial_wait};
    ale_port_offer("rtai:", &driver);
}
#else
static void offer_serial_driver(void)
{
}
#endif

static int fail(ale_rt_report_t *report, const char *why)
{
    report->realtime = false;
    snprintf(report->text, sizeof report->text, "%s", why);
    return -1;
}

/* The timer is the machine's: setting it up again would stop the tasks of other programs. */
static void start_timer(void)
{
    if (!rt_is_hard_timer_running()) {
        rt_set_oneshot_mode();
        start_rt_timer(0);
        state.timer_is_ours = true;
    }
}

int ale_rt_start(const ale_rt_config_t *config, ale_rt_report_t *report)
{
    memset(&state, 0, sizeof state);
    state.config = *config;
    if (access(ALE_RTAI_SCHEDULER, R_OK) < 0) {
        return fail(report, "this kernel has no RTAI (no /proc/rtai/scheduler): load its modules "
                            "(rtai_hal, rtai_sched, rtai_sem), or use a build without RT=rtai");
    }
    sched_getaffinity(0, sizeof state.cpus, &state.cpus);
    ale_rt_limit_default_stack();
    ale_rt_keep_heap();
    rt_allow_nonroot_hrt();
    state.memory_locked = config->lock_memory && ale_rt_lock_memory();
    state.main_task =
        rt_task_init_schmod(0, RT_SCHED_LOWEST_PRIORITY, 0, 0, SCHED_OTHER, cpu_mask(ALE_RT_ORDINARY));
    if (!state.main_task) {
        return fail(report, "RTAI gives this program no task: its memory or names have run out");
    }
    start_timer();
    offer_serial_driver();
    state.forced_before = forced_transitions();
    ale_rt_report(report);
    return 0;
}

void ale_rt_stop(void)
{
    if (state.timer_is_ours) {
        stop_rt_timer();
    }
    rt_task_delete(state.main_task);
    munlockall();
}

void ale_rt_report(ale_rt_report_t *report)
{
    const unsigned long forced = forced_transitions() - state.forced_before;
    ale_rt_findings_t findings = {0};
    ale_rt_found(&findings, atomic_load(&state.hard), "RTAI hard task");
    ale_rt_found(&findings, state.memory_locked, "locked memory");
    if (state.config.cpu >= 0) {
        ale_rt_found(&findings, has_cpu_of_its_own(), "processor %d", state.config.cpu);
    }
    ale_rt_found(&findings, true, "touched stacks");
    ale_rt_check_governor(&findings, state.config.cpu, "");
    if (forced > 0) {
        ale_rt_found(&findings, false, "hard tasks left to Linux %d times", (int)(forced & INT_MAX));
    }
    ale_rt_findings_report(&findings, report);
}

/* Own function: the pages it touches are below those of what it is called from, and free again when it
 * returns. */
static __attribute__((noinline)) void touch_stack(void)
{
    rt_grow_and_lock_stack(TOUCHED_BYTES);
}

static bool is_of_linux(const ale_rt_task_t *task)
{
    return task->config.kind == ALE_RT_ORDINARY || task->config.kind == ALE_RT_BACKGROUND;
}

/* Makes the calling thread what its kind says; all but hard. NULL: refused, or a thread that RTAI need not
 * know. */
static RT_TASK *enter(ale_rt_task_t *task)
{
    RT_TASK *lxrt = NULL;
    pthread_setname_np(pthread_self(), task->config.name);
    touch_stack();
    if (is_of_linux(task)) {
        pthread_setaffinity_np(pthread_self(), sizeof state.cpus, &state.cpus);
    } else {
        const bool realtime = state.config.priority > 0;
        lxrt = rt_task_init_schmod(0, realtime ? rtai_priority(task->config.kind) : RT_SCHED_LOWEST_PRIORITY,
                                   0, 0, realtime ? SCHED_FIFO : SCHED_OTHER, cpu_mask(task->config.kind));
        task->refused = lxrt == NULL;
        if (task->config.kind == ALE_RT_HARD) {
            atomic_store(&state.hard, lxrt && realtime);
        }
    }
    sem_post(&task->ready);
    return lxrt;
}

static void *run_task(void *user)
{
    ale_rt_task_t *task = user;
    RT_TASK *lxrt = enter(task);
    if (!is_of_linux(task) && !lxrt) {
        return NULL;
    }
    if (is_of_linux(task)) {
        ale_rt_grow_heap(ALE_RT_HEAP_BYTES + (size_t)task->config.heap_bytes);
    }
    if (task->config.kind == ALE_RT_HARD && state.config.priority > 0) {
        rt_make_hard_real_time();
    }
    task->config.body(task, task->config.user);
    if (lxrt) {
        rt_make_soft_real_time();
        rt_task_delete(lxrt);
    }
    return NULL;
}

/* A signal would push a hard task to Linux: all are blocked in what is started here. */
static long create_thread(ale_rt_task_t *task)
{
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const long thread = rt_thread_create((void *)run_task, task, ALE_RT_STACK_BYTES);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return thread;
}

static void wait_ready(ale_rt_task_t *task)
{
    while (sem_wait(&task->ready) < 0 && errno == EINTR) {
    }
}

ale_rt_task_t *ale_rt_task_start(const ale_rt_task_config_t *config)
{
    ale_rt_task_t *task = calloc(1, sizeof *task);
    if (!task) {
        return NULL;
    }
    task->config = *config;
    atomic_init(&task->stopping, false);
    sem_init(&task->ready, 0, 0);
    task->thread = create_thread(task);
    if (task->thread == 0) {
        sem_destroy(&task->ready);
        free(task);
        return NULL;
    }
    wait_ready(task);
    if (task->refused) {
        ale_rt_task_join(task);
        return NULL;
    }
    return task;
}

void ale_rt_task_stop(ale_rt_task_t *task)
{
    atomic_store(&task->stopping, true);
}

bool ale_rt_task_stopping(const ale_rt_task_t *self)
{
    return atomic_load_explicit(&self->stopping, memory_order_relaxed);
}

void ale_rt_task_join(ale_rt_task_t *task)
{
    if (task) {
        rt_thread_join(task->thread);
        sem_destroy(&task->ready);
        free(task);
    }
}

ale_rt_release_t *ale_rt_release_create(void)
{
    ale_rt_release_t *release = calloc(1, sizeof *release);
    if (release) {
        release->semaphore = rt_typed_sem_init(rt_get_name(NULL), 0, BIN_SEM | FIFO_Q);
    }
    if (release && !release->semaphore) {
        free(release);
        return NULL;
    }
    return release;
}

void ale_rt_release_destroy(ale_rt_release_t *release)
{
    if (release) {
        rt_sem_delete(release->semaphore);
        free(release);
    }
}

void ale_rt_release_post(ale_rt_release_t *release)
{
    rt_sem_signal(release->semaphore);
}

/* Waits for a span rather than until a moment: counts of RTAI's timer are then never mixed with nanoseconds.
 * A wait that blocked returns the count after it, which is 0; one that did not block, the count before it. */
bool ale_rt_release_wait(ale_rt_release_t *release, int64_t until_ns)
{
    const int64_t left_ns = until_ns - ale_rt_now_ns();
    if (left_ns <= 0) {
        const int count = rt_sem_wait_if(release->semaphore);
        return count > 0 && count < RTE_LOWERR;
    }
    return rt_sem_wait_timed(release->semaphore, nano2count(left_ns)) < RTE_LOWERR;
}
