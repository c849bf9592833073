#include <errno.h>

#include "include/rtai_sem.h"
#include "internal.h"

enum { KIND_SEMAPHORE = 2 };

typedef struct {
    bool used;
    int type;
    int count;   /* below 0: so many wait */
    int granted; /* of those that wait, so many may go */
    pthread_cond_t signalled;
} semaphore_t;

static semaphore_t semaphores[OBJECTS];

/* Called with the lock held. */
static SEM *make(unsigned long name, int value, int type)
{
    for (int k = 0; k < OBJECTS; k++) {
        if (!semaphores[k].used) {
            SEM *handle = rtai_handle(KIND_SEMAPHORE, k);
            if (!rtai_register(name, handle)) {
                return NULL;
            }
            pthread_condattr_t attributes;
            pthread_condattr_init(&attributes);
            pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
            semaphores[k] = (semaphore_t){.used = true, .type = type & ~PRIO_Q, .count = value};
            semaphores[k].type = type < 0 ? BIN_SEM : type & ~PRIO_Q;
            pthread_cond_init(&semaphores[k].signalled, &attributes);
            pthread_condattr_destroy(&attributes);
            return handle;
        }
    }
    return NULL;
}

SEM *rt_typed_sem_init(unsigned long name, int value, int type)
{
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    SEM *handle = make(name, value, type);
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return handle;
}

static semaphore_t *open_semaphore(SEM *handle)
{
    semaphore_t *semaphore = &semaphores[rtai_slot(KIND_SEMAPHORE, handle)];
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    return semaphore;
}

static int close_semaphore(int result)
{
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return result;
}

int rt_sem_delete(SEM *handle)
{
    semaphore_t *semaphore = open_semaphore(handle);
    if (!semaphore->used) {
        return close_semaphore(RTE_OBJINV);
    }
    semaphore->used = false;
    rtai_unregister(handle);
    pthread_cond_broadcast(&semaphore->signalled);
    return close_semaphore(0);
}

int rt_sem_signal(SEM *handle)
{
    semaphore_t *semaphore = open_semaphore(handle);
    if (!semaphore->used) {
        return close_semaphore(RTE_OBJINV);
    }
    semaphore->granted += semaphore->count < 0;
    semaphore->count += !(semaphore->type != CNT_SEM && semaphore->count >= 1);
    pthread_cond_signal(&semaphore->signalled);
    return close_semaphore(0);
}

int rt_sem_wait_if(SEM *handle)
{
    semaphore_t *semaphore = open_semaphore(handle);
    const int count = semaphore->count;
    semaphore->count -= count > 0;
    return close_semaphore(semaphore->used ? count : RTE_OBJINV);
}

/* Called with the lock held and nothing to take; until: NULL for ever. */
static int block(semaphore_t *semaphore, const struct timespec *until)
{
    int error = 0;
    semaphore->count--;
    while (semaphore->used && semaphore->granted == 0 && error != ETIMEDOUT) {
        error = until ? pthread_cond_timedwait(&semaphore->signalled, &rtai_lock, until)
                      : pthread_cond_wait(&semaphore->signalled, &rtai_lock);
    }
    if (!semaphore->used) {
        return RTE_OBJREM;
    }
    if (semaphore->granted == 0) {
        semaphore->count++;
        return RTE_TIMOUT;
    }
    semaphore->granted--;
    return semaphore->count;
}

static int wait(SEM *handle, const struct timespec *until)
{
    semaphore_t *semaphore = open_semaphore(handle);
    if (!semaphore->used) {
        return close_semaphore(RTE_OBJINV);
    }
    if (!rt_agent()) {
        rtai_misuse("a thread that is no task waits for a semaphore");
    }
    if (semaphore->count > 0) {
        return close_semaphore(semaphore->count--);
    }
    return close_semaphore(block(semaphore, until));
}

int rt_sem_wait(SEM *handle)
{
    return wait(handle, NULL);
}

int rt_sem_wait_until(SEM *handle, RTIME time)
{
    const struct timespec until = rtai_wake_time(time);
    return wait(handle, &until);
}

int rt_sem_wait_timed(SEM *handle, RTIME delay)
{
    return rt_sem_wait_until(handle, rt_get_time() + delay);
}
