#include "telemetry/realtime_watch.h"

#include <string.h>

static void run(ale_rt_task_t *self, void *user)
{
    ale_realtime_watch_t *watch = user;
    ale_rt_report_t last;
    watch->look(&last);
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&watch->thread, watch->period_ns);
        ale_rt_report_t *report = ale_snapshot_back(watch->reports);
        watch->look(report);
        if (report->realtime != last.realtime || strcmp(report->text, last.text) != 0) {
            last = *report;
            ale_snapshot_publish(watch->reports);
        }
    }
}

int ale_realtime_watch_start(ale_realtime_watch_t *watch, void (*look)(ale_rt_report_t *report),
                             int64_t period_ns)
{
    watch->look = look;
    watch->period_ns = period_ns;
    watch->reports = ale_snapshot_create(sizeof(ale_rt_report_t));
    if (!watch->reports || ale_background_start(&watch->thread, "ale-realtime", run, watch, 0) < 0) {
        ale_realtime_watch_stop(watch);
        return -1;
    }
    return 0;
}

void ale_realtime_watch_stop(ale_realtime_watch_t *watch)
{
    ale_background_stop(&watch->thread);
    ale_snapshot_destroy(watch->reports);
    watch->reports = NULL;
}

bool ale_realtime_watch_changed(ale_realtime_watch_t *watch, ale_rt_report_t *report)
{
    bool fresh = false;
    if (watch->reports) {
        const ale_rt_report_t *newest = ale_snapshot_newest(watch->reports, &fresh);
        if (fresh) {
            *report = *newest;
        }
    }
    return fresh;
}
