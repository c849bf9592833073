#include "acquire/acquire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/config_model.h"
#include "exchange/wake.h"
#include "recorder/recorder.h"
#include "scanner/scanner.h"

struct ale_acquire {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_scanner_t *scanner;
    char model[64]; /* that the scanner told last, and the noise that goes with it */
    ale_noise_t noise;
    ale_rt_task_t *task;
    ale_scan_t scan;
};

static int64_t robot_clock(void *user)
{
    return ale_clock_now_us(user);
}

static void record_bytes(void *user, bool sent, const uint8_t *bytes, uint32_t count, int64_t now_us)
{
    ale_recorder_bytes(user, sent, bytes, count, now_us);
}

static ale_scanner_config_t scanner_config(const ale_config_t *config, const ale_exchange_t *exchange)
{
    const ale_clock_t *clock = &exchange->clock;
    return (ale_scanner_config_t){
        .family = config->type,
        .path = config->port[0] ? config->port : NULL,
        .serial = config->serial[0] ? config->serial : NULL,
        .baud = config->baud,
        .reversed = config->reversed,
        .first_step = config->first_step,
        .last_step = config->last_step,
        .time_scale = (double)clock->scale_ppm / ALE_CLOCK_REAL,
        .tap = record_bytes,
        .tap_user = exchange->recorder,
        .now_us = robot_clock,
        .now_user = (void *)clock,
        .utime_offset_us = clock->offset_us,
    };
}

/* Another scanner is there, or it is known which one: it is as rough as its preset says, but for what [noise]
 * says. */
static void follow_identity(ale_acquire_t *acquire)
{
    const char *model = ale_scanner_health(acquire->scanner)->identity.model;
    if (strcmp(model, acquire->model) != 0) {
        ale_config_t config = *acquire->config;
        snprintf(acquire->model, sizeof acquire->model, "%s", model);
        ale_config_preset(&config, model, config.model);
        ale_config_use_preset(&config, config.model);
        acquire->noise = config.pipeline.extract.noise;
        ale_recorder_preset(acquire->exchange->recorder, config.model);
    }
}

static void hand_over(ale_acquire_t *acquire, bool lost)
{
    ale_exchange_t *exchange = acquire->exchange;
    ale_scan_record_t *record = ale_ring_reserve(exchange->scans);
    if (!record) {
        return;
    }
    record->lost = lost;
    if (lost) {
        record->arrival_us = ale_clock_now_us(&exchange->clock);
        record->scan.stamp_us = acquire->scan.stamp_us;
        record->scan.beams = 0;
    } else {
        record->arrival_us = ale_scanner_health(acquire->scanner)->arrival_us;
        record->scan = acquire->scan;
        record->noise = acquire->noise;
    }
    ale_ring_commit(exchange->scans);
    ale_recorder_scan(exchange->recorder, ale_ring_committed(exchange->scans) - 1);
    ale_rt_release_post(exchange->arrived);
}

static void tell_health(ale_acquire_t *acquire)
{
    memcpy(ale_snapshot_back(acquire->exchange->health), ale_scanner_health(acquire->scanner),
           sizeof(ale_scanner_health_t));
    ale_snapshot_publish(acquire->exchange->health);
    ale_wake_post(acquire->exchange->under_way);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_acquire_t *acquire = user;
    while (!ale_rt_task_stopping(self)) {
        const ale_scanner_event_t event = ale_scanner_step(acquire->scanner, &acquire->scan);
        if (event == ALE_SCANNER_IDLE) {
            continue;
        }
        follow_identity(acquire);
        if (event != ALE_SCANNER_CHANGED) {
            hand_over(acquire, event == ALE_SCANNER_SCAN_LOST);
        }
        tell_health(acquire);
    }
}

ale_acquire_t *ale_acquire_start(const ale_config_t *config, ale_exchange_t *exchange)
{
    ale_acquire_t *acquire = calloc(1, sizeof *acquire);
    if (!acquire) {
        return NULL;
    }
    const ale_scanner_config_t scanner = scanner_config(config, exchange);
    acquire->config = config;
    acquire->noise = config->pipeline.extract.noise;
    acquire->exchange = exchange;
    acquire->scanner = ale_scanner_open(&scanner);
    if (acquire->scanner) {
        acquire->task = ale_rt_task_start(&(ale_rt_task_config_t){
            .name = "ale-acquire", .kind = ALE_RT_SOFT, .body = run, .user = acquire});
    }
    if (!acquire->task) {
        ale_acquire_stop(acquire);
        return NULL;
    }
    return acquire;
}

void ale_acquire_stop(ale_acquire_t *acquire)
{
    if (!acquire) {
        return;
    }
    if (acquire->task) {
        ale_rt_task_stop(acquire->task);
    }
    ale_rt_task_join(acquire->task);
    ale_scanner_close(acquire->scanner);
    free(acquire);
}
