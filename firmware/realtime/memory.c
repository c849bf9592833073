#include "realtime/memory.h"

#include <limits.h>
#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { LIBRARY_STACK_BYTES = 1024 * 1024, PAGE_BYTES = 4096 };

static bool may_lock_all_memory(void)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct rights[_LINUX_CAPABILITY_U32S_3] = {0};
    struct rlimit limit = {0};
    const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    const bool asked = syscall(SYS_capget, &header, rights) == 0;
    return unlimited || (asked && (rights[0].effective & (1U << CAP_IPC_LOCK)) != 0);
}

bool ale_rt_lock_memory(void)
{
    return may_lock_all_memory() && mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
}

void ale_rt_limit_default_stack(void)
{
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, LIBRARY_STACK_BYTES);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
}

void ale_rt_keep_heap(void)
{
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
}

void ale_rt_touch(void *memory, size_t bytes)
{
    volatile char *byte = memory;
    for (size_t k = 0; k < bytes; k += PAGE_BYTES) {
        const char what_is_in_it = byte[k];
        byte[k] = what_is_in_it;
    }
}

void ale_rt_grow_heap(size_t bytes)
{
    void *memory = calloc(1, bytes);
    if (memory) {
        ale_rt_touch(memory, bytes);
        free(memory);
    }
}
