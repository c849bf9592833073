/* A thread without priority that waits until there is something to do: what is computed, written or read
 * beside the way from scan to pose.
 *
 *   ale_background_start(&maker->thread, "ale-maker", body, maker, 0);
 *       body:  while (!ale_rt_task_stopping(self)) { ale_background_wait(&maker->thread, LOOK_NS); work }
 *   ale_background_wake(&maker->thread);                (whoever has something for it)
 *   ale_background_stop(&maker->thread); */
#ifndef ALE_FIRMWARE_SYSTEM_BACKGROUND_H
#define ALE_FIRMWARE_SYSTEM_BACKGROUND_H

#include "realtime/rt.h"

/* All zero: not started. */
typedef struct {
    ale_rt_task_t *task;
    int wake; /* wake.h */
} ale_background_t;

/* name, body, user, heap_bytes: as in ale_rt_task_config_t. -1: the system has no more descriptors or
 * threads; then it is as before the start. */
int ale_background_start(ale_background_t *background, const char *name,
                         void (*body)(ale_rt_task_t *self, void *user), void *user, uint32_t heap_bytes);

/* Asks it to end, wakes it and waits for its end. Not started: nothing. */
void ale_background_stop(ale_background_t *background);

/* Any thread, while it is started; never blocks. */
void ale_background_wake(const ale_background_t *background);

/* From the body alone: until it is woken, or wait_ns are over. */
void ale_background_wait(const ale_background_t *background, int64_t wait_ns);

#endif
