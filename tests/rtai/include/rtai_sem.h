/* Semaphores. A wait that blocked returns the count after it (0), one that did not the count before it. */
#ifndef RTAI_SEM_H
#define RTAI_SEM_H

#include "rtai_lxrt.h"

#define CNT_SEM 0
#define BIN_SEM (-1)
#define RES_SEM 1
#define FIFO_Q 0
#define PRIO_Q 4

#ifdef __cplusplus
extern "C" {
#endif

SEM *rt_typed_sem_init(unsigned long name, int value, int type);
int rt_sem_delete(SEM *semaphore);
int rt_sem_signal(SEM *semaphore);
int rt_sem_wait(SEM *semaphore);
int rt_sem_wait_if(SEM *semaphore);
int rt_sem_wait_until(SEM *semaphore, RTIME time);
int rt_sem_wait_timed(SEM *semaphore, RTIME delay);

#ifdef __cplusplus
}
#endif

#endif
