/* The real-time port: all that the firmware wants of a real-time kernel, in one small interface.
 *
 *   ale_rt_start(&config, &report);                       main, before anything else
 *   task = ale_rt_task_start(&(ale_rt_task_config_t){.kind = ALE_RT_HARD, .body = loop, ...});
 *       loop:  while (!ale_rt_task_stopping(self)) { ale_rt_release_wait(release, until_ns); work }
 *   ale_rt_report(&report);                               what was got, after the tasks have started
 *   ale_rt_task_stop(task); ale_rt_release_post(release); ale_rt_task_join(task);
 *   ale_rt_stop();
 *
 * Back ends: rt_posix.c (SCHED_FIFO; hard under PREEMPT_RT), rt_rtai.c (RTAI/LXRT). A hard task waits on one
 * object that others may signal, time is read and never set, and nothing is started, allocated or printed
 * between release and wait. */
#ifndef ALE_FIRMWARE_REALTIME_RT_H
#define ALE_FIRMWARE_REALTIME_RT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int32_t priority; /* 1..97 of the hard task, 0: no real time wanted */
    int32_t cpu;      /* of the hard task; -1: any */
    bool lock_memory;
} ale_rt_config_t;

typedef struct {
    bool realtime; /* all that was asked for, on a kernel that keeps its promises */
    char text[440];
} ale_rt_report_t;

/* Memory, limits and kernel. 0, or -1 when this back end cannot run on this kernel at all (report->text
 * says why). Once, from main. */
int ale_rt_start(const ale_rt_config_t *config, ale_rt_report_t *report);
void ale_rt_stop(void);

/* What was got and what is missing so far, one line. */
void ale_rt_report(ale_rt_report_t *report);

/* Monotonic nanoseconds. Any thread; no system call. */
int64_t ale_rt_now_ns(void);

typedef enum {
    ALE_RT_HARD,      /* the estimate task: configured priority and processor */
    ALE_RT_SOFT,      /* works for it, may make system calls: one priority below */
    ALE_RT_ORDINARY,  /* two below where that costs nothing, else like any program */
    ALE_RT_BACKGROUND /* always like any program: may wait for disks */
} ale_rt_kind_t;

typedef struct ale_rt_task ale_rt_task_t;

typedef struct {
    const char *name; /* at most 15 characters */
    ale_rt_kind_t kind;
    void (*body)(ale_rt_task_t *self, void *user);
    void *user;
    uint32_t heap_bytes; /* what an ordinary or background task needs beyond ALE_RT_HEAP_BYTES */
} ale_rt_task_config_t;

/* Starts a task with its stack (ALE_RT_STACK_BYTES) touched; all signals are blocked in it. Ordinary and
 * background tasks begin with a heap of their own, touched, and it never shrinks: as far as the system has so
 * much. Without the right to a priority it starts without one. NULL: the system has no more threads. */
enum { ALE_RT_STACK_BYTES = 1024 * 1024, ALE_RT_HEAP_BYTES = 512 * 1024 };
ale_rt_task_t *ale_rt_task_start(const ale_rt_task_config_t *config);
void ale_rt_task_stop(ale_rt_task_t *task); /* asks; any thread */
bool ale_rt_task_stopping(const ale_rt_task_t *self);
void ale_rt_task_join(ale_rt_task_t *task); /* waits for its end and frees it; NULL: nothing */

/* What a hard or soft task waits on; other threads have wake.h. Any thread may post. Posts before a wait
 * count as one. */
typedef struct ale_rt_release ale_rt_release_t;
ale_rt_release_t *ale_rt_release_create(void);
void ale_rt_release_destroy(ale_rt_release_t *release);
void ale_rt_release_post(ale_rt_release_t *release);
/* True when posted since the last wait, false when the moment (of ale_rt_now_ns) has come. One system call,
 * the only one of the estimate task. One waiting task. */
bool ale_rt_release_wait(ale_rt_release_t *release, int64_t until_ns);

#endif
