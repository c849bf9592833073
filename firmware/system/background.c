#include "system/background.h"

#include <stddef.h>

#include "exchange/wake.h"

int ale_background_start(ale_background_t *background, const char *name,
                         void (*body)(ale_rt_task_t *self, void *user), void *user, uint32_t heap_bytes)
{
    background->wake = ale_wake_open();
    if (background->wake < 0) {
        return -1;
    }
    background->task = ale_rt_task_start(&(ale_rt_task_config_t){
        .name = name, .kind = ALE_RT_BACKGROUND, .body = body, .user = user, .heap_bytes = heap_bytes});
    if (!background->task) {
        ale_wake_close(background->wake);
        return -1;
    }
    return 0;
}

void ale_background_stop(ale_background_t *background)
{
    if (background->task) {
        ale_rt_task_stop(background->task);
        ale_background_wake(background);
        ale_rt_task_join(background->task);
        ale_wake_close(background->wake);
        background->task = NULL;
    }
}

void ale_background_wake(const ale_background_t *background)
{
    ale_wake_post(background->wake);
}

void ale_background_wait(const ale_background_t *background, int64_t wait_ns)
{
    ale_wake_wait(background->wake, wait_ns);
}
