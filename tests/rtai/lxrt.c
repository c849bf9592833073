/* Tasks of LXRT, their modes and periods, over POSIX threads. */
#include "include/rtai_lxrt.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "emulation.h"
#include "guard.h"
#include "internal.h"

enum { KIND_TASK = 1 };

typedef struct {
    bool used;
    int hard; /* 1, 0, or -1: goes back to hard by its next call */
    RTIME release;
    RTIME period;
} task_t;

pthread_mutex_t rtai_lock = PTHREAD_MUTEX_INITIALIZER;

static struct {
    bool absent;
    bool signal;
    bool refuse;
    task_t tasks[OBJECTS];
    int scheduler; /* descriptor of the file, 0: none yet */
} rtai;

static _Thread_local task_t *self;

_Noreturn void rtai_misuse(const char *what)
{
    fprintf(stderr, "RTAI emulation: %s\n", what);
    abort();
}

void rtai_enter(void)
{
    guard_leave();
    if (self && self->hard < 0) {
        self->hard = 1;
        guard_set_hard(true);
    }
}

void rtai_leave(void)
{
    guard_return();
}

void rt_allow_nonroot_hrt(void)
{
}

static RT_TASK *register_task(unsigned long name)
{
    RT_TASK *handle = NULL;
    pthread_mutex_lock(&rtai_lock);
    for (int k = 0; k < OBJECTS && !handle && !rtai.refuse; k++) {
        if (!rtai.tasks[k].used) {
            handle = rtai_handle(KIND_TASK, k);
            handle = rtai_register(name ? name : rtai_next_name(), handle) ? handle : NULL;
            if (!handle) {
                break;
            }
            self = &rtai.tasks[k];
            *self = (task_t){.used = true};
        }
    }
    rtai.refuse = false;
    pthread_mutex_unlock(&rtai_lock);
    return handle;
}

static cpu_set_t machine; /* its processors, as the program finds them */

__attribute__((constructor)) static void look_at_machine(void)
{
    sched_getaffinity(0, sizeof machine, &machine);
}

/* Binds the thread to one processor of the mask, for good, whatever it has inherited; 0: the one it is on. */
static void bind_to_cpu(int cpus_allowed)
{
    cpu_set_t one;
    int chosen = sched_getcpu();
    for (int cpu = 0; cpu < 31 && cpus_allowed != 0; cpu++) {
        if ((cpus_allowed >> cpu & 1) != 0 && CPU_ISSET((size_t)cpu, &machine)) {
            chosen = cpu;
            break;
        }
    }
    CPU_ZERO(&one);
    CPU_SET((size_t)chosen, &one);
    sched_setaffinity(0, sizeof one, &one);
}

/* Priorities are taken where this machine grants them: RTAI itself would. */
RT_TASK *rt_task_init_schmod(unsigned long name, int priority, int stack_size, int max_msg_size, int policy,
                             int cpus_allowed)
{
    (void)stack_size;
    (void)max_msg_size;
    if (self) {
        return rt_agent();
    }
    const int wanted = policy == SCHED_OTHER ? 0 : sched_get_priority_max(policy) - priority;
    const struct sched_param parameter = {.sched_priority = policy != SCHED_OTHER && wanted < 1 ? 1 : wanted};
    sched_setscheduler(0, policy, &parameter);
    bind_to_cpu(cpus_allowed);
    return register_task(name);
}

RT_TASK *rt_task_init(unsigned long name, int priority, int stack_size, int max_msg_size)
{
    return rt_task_init_schmod(name, priority, stack_size, max_msg_size, SCHED_FIFO, 0xFF);
}

RT_TASK *rt_agent(void)
{
    return self ? rtai_handle(KIND_TASK, (int)(self - rtai.tasks)) : NULL;
}

/* A task can delete only itself; it is soft from then on. */
int rt_thread_delete(RT_TASK *task)
{
    rtai_enter();
    const bool own = self && (!task || task == rt_agent());
    if (own) {
        guard_set_hard(false);
        pthread_mutex_lock(&rtai_lock);
        rtai_unregister(rt_agent());
        self->used = false;
        self = NULL;
        pthread_mutex_unlock(&rtai_lock);
    }
    rtai_leave();
    return own ? 0 : -EPERM;
}

static const task_t *task_of(RT_TASK *task)
{
    return task ? &rtai.tasks[rtai_slot(KIND_TASK, task)] : self;
}

void rt_make_hard_real_time(void)
{
    rtai_enter();
    if (!self) {
        rtai_misuse("a thread that is no task wants to be hard");
    }
    self->hard = rtai.signal ? -1 : 1;
    rtai.signal = false;
    guard_set_hard(self->hard > 0);
    rtai_leave();
}

void rt_make_soft_real_time(void)
{
    rtai_enter();
    if (self) {
        self->hard = 0;
    }
    guard_set_hard(false);
    rtai_leave();
}

/* The answer is of before the call, which itself takes the task back to hard. */
int rt_is_hard_real_time(RT_TASK *task)
{
    const task_t *asked = task_of(task);
    const int hard = asked ? asked->hard : 0;
    rtai_enter();
    rtai_leave();
    return hard;
}

long rt_thread_create(void *function, void *arguments, int stack_size)
{
    enum { SMALLEST = 16384 };
    pthread_t thread;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, (size_t)(stack_size < SMALLEST ? SMALLEST : stack_size));
    const int result = pthread_create(&thread, &attributes, (void *(*)(void *))function, arguments);
    pthread_attr_destroy(&attributes);
    return result == 0 ? (long)thread : 0;
}

int rt_thread_join(long thread)
{
    return pthread_join((pthread_t)thread, NULL);
}

/* For the calling task: comes back at the first release. */
int rt_task_make_periodic(RT_TASK *task, RTIME start_time, RTIME period)
{
    const bool own = self && task == rt_agent();
    if (!own || period <= 0) {
        return -EINVAL;
    }
    rtai_enter();
    self->release = start_time;
    self->period = period;
    rtai_sleep_until(start_time);
    rtai_leave();
    return 0;
}

/* One period further at each call, also when that is past already. */
int rt_task_wait_period(void)
{
    if (!self || self->period <= 0) {
        rtai_misuse("a wait for the period of a task that has none");
    }
    self->release += self->period;
    if (self->release <= rt_get_time()) {
        return RTE_TMROVRN;
    }
    rtai_enter();
    rtai_sleep_until(self->release);
    rtai_leave();
    return 0;
}

void rtai_emulated_absent(bool absent)
{
    rtai.absent = absent;
}

void rtai_emulated_forced(int traps, int calls)
{
    char text[200];
    rtai_emulated_scheduler();
    const int length = snprintf(text, sizeof text,
                                "\nRTAI LXRT Real Time Task Scheduler.\n\n"
                                "Number of forced hard/soft/hard transitions: traps %d, syscalls %d\n\n",
                                traps, calls);
    if (ftruncate(rtai.scheduler, 0) < 0 || pwrite(rtai.scheduler, text, (size_t)length, 0) != length) {
        rtai_misuse("the scheduler's file cannot be written");
    }
}

void rtai_emulated_signal(void)
{
    rtai.signal = true;
}

void rtai_emulated_refuse(void)
{
    rtai.refuse = true;
}

const char *rtai_emulated_scheduler(void)
{
    static char path[40];
    if (rtai.absent) {
        return "/proc/rtai/scheduler";
    }
    if (rtai.scheduler == 0) {
        rtai.scheduler = memfd_create("rtai-scheduler", MFD_CLOEXEC);
        snprintf(path, sizeof path, "/proc/self/fd/%d", rtai.scheduler);
        rtai_emulated_forced(0, 0);
    }
    return path;
}
