/* Looks again and again whether real time is still what it was at the start: a governor that somebody sets,
 * tasks that Linux took over. In the background, for it reads files. */
#ifndef ALE_FIRMWARE_TELEMETRY_REALTIME_WATCH_H
#define ALE_FIRMWARE_TELEMETRY_REALTIME_WATCH_H

#include "exchange/snapshot.h"
#include "realtime/rt.h"
#include "system/background.h"

/* All zero: not started. Fields are private. */
typedef struct {
    void (*look)(ale_rt_report_t *report);
    int64_t period_ns;
    ale_snapshot_t *reports; /* ale_rt_report_t */
    ale_background_t thread;
} ale_realtime_watch_t;

/* look: ale_rt_report; any thread may call it. -1: the system has no more memory, descriptors or threads;
 * then nothing changes for ale_realtime_watch_changed. */
int ale_realtime_watch_start(ale_realtime_watch_t *watch, void (*look)(ale_rt_report_t *report),
                             int64_t period_ns);

/* Not started: nothing. */
void ale_realtime_watch_stop(ale_realtime_watch_t *watch);

/* One thread, never blocks: true when the report is another one than at the last call, or at the start; then
 * it is in *report. */
bool ale_realtime_watch_changed(ale_realtime_watch_t *watch, ale_rt_report_t *report);

#endif
