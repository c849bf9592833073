/* Stages of a scan's processing, for those who want to time them. lib has no clock: whoever has one passes a
 * hook, which is called at the end of each stage (a stage may end more than once in a scan), from the thread
 * that computes. What `user` points to belongs to whoever set the hook. */
#ifndef ALE_BASE_STAGE_H
#define ALE_BASE_STAGE_H

typedef enum {
    ALE_STAGE_DESKEW,
    ALE_STAGE_SMOOTH,
    ALE_STAGE_EXTRACT,
    ALE_STAGE_MATCH,
    ALE_STAGE_MAP,
    ALE_STAGES
} ale_stage_t;

typedef struct {
    void (*end_of)(void *user, ale_stage_t stage); /* NULL: nobody asks */
    void *user;
} ale_stage_hook_t;

/* Tells the hook, if there is one. */
static inline void ale_stage_end(const ale_stage_hook_t *hook, ale_stage_t stage)
{
    if (hook->end_of) {
        hook->end_of(hook->user, stage);
    }
}

#endif
