/* Times, handles and errors. Handles are addresses in a kernel: there is nothing behind them here. */
#ifndef RTAI_TYPES_H
#define RTAI_TYPES_H

#include "rtai_config.h"

typedef long long RTIME;
typedef struct rt_task_struct RT_TASK;
typedef struct rt_semaphore SEM;
typedef struct rt_mailbox MBX;

#define RTE_BASE 0x3FFFFF00
#define RTE_TMROVRN (RTE_BASE + 1)
#define RTE_UNBLKD (RTE_BASE + 2)
#define RTE_TIMOUT (RTE_BASE + 3)
#define RTE_OBJREM (RTE_BASE + 4)
#define RTE_OBJINV (RTE_BASE + 5)
#define RTE_PERM (RTE_BASE + 6)
#define RTE_LOWERR RTE_TMROVRN
#define RTE_HIGERR (RTE_BASE + 11)
#define rt_is_reterr(result) ((result) >= RTE_LOWERR)

#define RT_SCHED_HIGHEST_PRIORITY 0
#define RT_SCHED_LOWEST_PRIORITY 0x3fffffff

#endif
