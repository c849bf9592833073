/* Memory of a real-time process: all of it locked, stacks of a size that can be, heaps that do not breathe.
 */
#ifndef ALE_FIRMWARE_REALTIME_MEMORY_H
#define ALE_FIRMWARE_REALTIME_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/* Locks what is there and what will be. False when a limit or a missing right forbids it: then nothing is
 * locked, because under a limit later allocations would fail. */
bool ale_rt_lock_memory(void);

/* From now on threads of libraries get a stack of 1 MB: locked, the usual 8 MB would all be taken. */
void ale_rt_limit_default_stack(void);

/* From now on what malloc has from the system it keeps: no page comes or goes while memory of a bounded size
 * is taken and given back. */
void ale_rt_keep_heap(void);

/* Writes to every page, so that all are there from now on; what is in them stays. */
void ale_rt_touch(void *memory, size_t bytes);

/* Grows the heap of the calling thread by so many bytes, touched; not at all where the system has not so
 * much. */
void ale_rt_grow_heap(size_t bytes);

#endif
