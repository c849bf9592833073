/* Memory of a real-time process: all of it locked, and stacks of a size that can be. */
#ifndef ALE_FIRMWARE_MEMORY_H
#define ALE_FIRMWARE_MEMORY_H

#include <stdbool.h>

/* Locks what is there and what will be. False when a limit or a missing right forbids it: then nothing is
 * locked, because under a limit later allocations would fail. */
bool ale_rt_lock_memory(void);

/* From now on threads of libraries get a stack of 1 MB: locked, the usual 8 MB would all be taken. */
void ale_rt_limit_default_stack(void);

#endif
