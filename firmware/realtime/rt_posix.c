/* The real-time port over POSIX and Linux: SCHED_FIFO, locked memory, touched stacks, futex. */
#include "realtime/rt.h"

#include <errno.h>
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "realtime/findings.h"
#include "realtime/machine.h"
#include "realtime/memory.h"

#define NS_PER_S 1000000000

enum { GUARD_BYTES = 65536 }; /* a page or more, whatever its size */

struct ale_rt_task {
    pthread_t thread;
    uint8_t *stack; /* with its guard page */
    ale_rt_task_config_t config;
    atomic_bool stopping;
};

struct ale_rt_release {
    atomic_uint posted; /* 0 or 1; the futex word */
};

/* What was got, for the report. Written by main alone. */
static struct {
    ale_rt_config_t config;
    bool memory_locked;
    bool priority_refused;
    bool cpu_refused;
} state;

int64_t ale_rt_now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * NS_PER_S + now.tv_nsec;
}

int ale_rt_start(const ale_rt_config_t *config, ale_rt_report_t *report)
{
    memset(&state, 0, sizeof state);
    state.config = *config;
    ale_rt_limit_default_stack();
    ale_rt_keep_heap();
    state.memory_locked = config->lock_memory && ale_rt_lock_memory();
    ale_rt_report(report);
    return 0;
}

void ale_rt_stop(void)
{
    if (state.memory_locked) {
        munlockall();
    }
}

void ale_rt_report(ale_rt_report_t *report)
{
    const ale_rt_config_t *config = &state.config;
    ale_rt_findings_t findings = {0};
    if (config->priority > 0) {
        ale_rt_found(&findings, !state.priority_refused, "SCHED_FIFO %d", config->priority);
    } else {
        ale_rt_found(&findings, false, "priority (none asked for)");
    }
    ale_rt_found(&findings, state.memory_locked, "locked memory");
    if (config->cpu >= 0) {
        ale_rt_found(&findings, !state.cpu_refused, "processor %d", config->cpu);
    }
    ale_rt_found(&findings, true, "touched stacks");
    ale_rt_check_kernel(&findings, "");
    ale_rt_check_timer(&findings);
    ale_rt_check_governor(&findings, config->cpu, "");
    ale_rt_findings_report(&findings, report);
}

static void *run_task(void *user)
{
    ale_rt_task_t *task = user;
    if (task->config.kind == ALE_RT_ORDINARY || task->config.kind == ALE_RT_BACKGROUND) {
        ale_rt_grow_heap(ALE_RT_HEAP_BYTES + (size_t)task->config.heap_bytes);
    }
    task->config.body(task, task->config.user);
    return NULL;
}

/* A stack whose pages are all there before the first release, above a page that no overflow can pass. */
static uint8_t *make_stack(void)
{
    uint8_t *memory = mmap(NULL, GUARD_BYTES + ALE_RT_STACK_BYTES, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    if (memory == MAP_FAILED) {
        return NULL;
    }
    mprotect(memory, GUARD_BYTES, PROT_NONE);
    memset(memory + GUARD_BYTES, 0, ALE_RT_STACK_BYTES);
    return memory;
}

static int create_thread(ale_rt_task_t *task, int priority)
{
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, task->stack + GUARD_BYTES, ALE_RT_STACK_BYTES);
    if (priority > 0) {
        const struct sched_param parameter = {.sched_priority = priority};
        pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
        pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
        pthread_attr_setschedparam(&attributes, &parameter);
    }
    const int result = pthread_create(&task->thread, &attributes, run_task, task);
    pthread_attr_destroy(&attributes);
    return result;
}

static void free_task(ale_rt_task_t *task)
{
    if (task->stack) {
        munmap(task->stack, GUARD_BYTES + ALE_RT_STACK_BYTES);
    }
    free(task);
}

/* With its priority if that is allowed, else without. */
static int create_with_priority(ale_rt_task_t *task)
{
    const int32_t below = task->config.kind == ALE_RT_HARD ? 0 : (task->config.kind == ALE_RT_SOFT ? 1 : 2);
    const bool background = task->config.kind == ALE_RT_BACKGROUND;
    const int32_t priority = background ? 0 : state.config.priority - below;
    if (priority > 0 && !state.priority_refused) {
        if (create_thread(task, priority) == 0) {
            return 0;
        }
        state.priority_refused = true;
    }
    return create_thread(task, 0);
}

static void pin_to_cpu(const ale_rt_task_t *task)
{
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET((size_t)state.config.cpu, &cpus);
    state.cpu_refused = pthread_setaffinity_np(task->thread, sizeof cpus, &cpus) != 0;
}

ale_rt_task_t *ale_rt_task_start(const ale_rt_task_config_t *config)
{
    ale_rt_task_t *task = calloc(1, sizeof *task);
    if (!task) {
        return NULL;
    }
    task->config = *config;
    atomic_init(&task->stopping, false);
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    task->stack = make_stack();
    const int result = task->stack ? create_with_priority(task) : ENOMEM;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (result != 0) {
        free_task(task);
        return NULL;
    }
    pthread_setname_np(task->thread, config->name);
    if (config->kind == ALE_RT_HARD && state.config.cpu >= 0) {
        pin_to_cpu(task);
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
        pthread_join(task->thread, NULL);
        free_task(task);
    }
}

ale_rt_release_t *ale_rt_release_create(void)
{
    return calloc(1, sizeof(ale_rt_release_t));
}

void ale_rt_release_destroy(ale_rt_release_t *release)
{
    free(release);
}

void ale_rt_release_post(ale_rt_release_t *release)
{
    if (atomic_exchange(&release->posted, 1) == 0) {
        syscall(SYS_futex, &release->posted, FUTEX_WAKE_PRIVATE, 1, NULL, NULL, 0);
    }
}

bool ale_rt_release_wait(ale_rt_release_t *release, int64_t until_ns)
{
    const struct timespec until = {.tv_sec = (time_t)(until_ns / NS_PER_S),
                                   .tv_nsec = (long)(until_ns % NS_PER_S)};
    if (atomic_exchange(&release->posted, 0) == 1) {
        return true;
    }
    /* Returns at once with EAGAIN when a post came in between; a spurious return is one early time-out. */
    syscall(SYS_futex, &release->posted, FUTEX_WAIT_BITSET_PRIVATE, 0, &until, NULL, FUTEX_BITSET_MATCH_ANY);
    return atomic_exchange(&release->posted, 0) == 1;
}
