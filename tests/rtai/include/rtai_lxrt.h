/* Tasks, timer, time and modes of LXRT, emulated. Signatures are those of RTAI 3.9 to 5.3. */
#ifndef RTAI_LXRT_H
#define RTAI_LXRT_H

#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>

#include "rtai_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where /proc/rtai/scheduler would be; nowhere when the emulation is told to be absent. */
const char *rtai_emulated_scheduler(void);
#define ALE_RTAI_SCHEDULER rtai_emulated_scheduler()

unsigned long nam2num(const char *name);
unsigned long rt_get_name(void *object);
void *rt_get_adr(unsigned long name);

void rt_allow_nonroot_hrt(void);
RT_TASK *rt_task_init_schmod(unsigned long name, int priority, int stack_size, int max_msg_size, int policy,
                             int cpus_allowed);
RT_TASK *rt_task_init(unsigned long name, int priority, int stack_size, int max_msg_size);
int rt_thread_delete(RT_TASK *task);
#define rt_task_delete(task) rt_thread_delete(task)
RT_TASK *rt_agent(void);
#define rt_buddy() rt_agent()

#define rt_grow_and_lock_stack(incr)                                                                         \
    do {                                                                                                     \
        char buf[incr];                                                                                      \
        memset(buf, 0, incr);                                                                                \
        mlockall(MCL_CURRENT | MCL_FUTURE);                                                                  \
    } while (0)

void rt_set_oneshot_mode(void);
void rt_set_periodic_mode(void);
RTIME start_rt_timer(int period);
void stop_rt_timer(void);
int rt_is_hard_timer_running(void);
RTIME nano2count(RTIME nanoseconds);
RTIME count2nano(RTIME counts);
RTIME rt_get_time(void);
RTIME rt_get_time_ns(void);

int rt_task_make_periodic(RT_TASK *task, RTIME start_time, RTIME period);
int rt_task_wait_period(void);
int rt_sleep(RTIME delay);

void rt_make_hard_real_time(void);
void rt_make_soft_real_time(void);
int rt_is_hard_real_time(RT_TASK *task);

long rt_thread_create(void *function, void *arguments, int stack_size);
int rt_thread_join(long thread);

#ifdef __cplusplus
}
#endif

#endif
