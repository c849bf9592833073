#include "telemetry/telemetry.h"

#include <errno.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

#include "base/fixed.h"
#include "exchange/wake.h"
#include "operator/commands.h"
#include "operator/explore_thread.h"
#include "recorder/recorder.h"
#include "system/async_logger.h"
#include "system/map_storage.h"
#include "system/persistence.h"
#include "system/service.h"
#include "telemetry/map_publisher.h"
#include "telemetry/statistics.h"
#include "telemetry/supervisor.h"

#define NS_PER_S 1000000000
#define STATUS_PERIOD_NS NS_PER_S
#define NEWS_PERIOD_NS 50000000 /* between statuses that tell of commands */

struct ale_telemetry {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    ale_rt_task_t *task;
    sem_t listening; /* posted once, when LCM is heard */
    ale_rt_report_t realtime;
    int64_t boot;
    ale_map_storage_t *storage;
    ale_commands_t *commands;
    ale_supervisor_t supervisor;
    ale_statistics_t statistics;
    const ale_scanner_health_t *health;
    ale_map_publisher_t map;
    int64_t next_status_ns;
    int64_t last_status_ns;
    bool news;     /* of commands, not yet in a status */
    bool refusals; /* not yet in a status: shown soon, but many of them do not make many statuses */
    int64_t next_keep_ns;
    ale_pose_t pose; /* in the map, newest */
    uint32_t epoch;  /* of that map */
    ale_service_t service;
    ale_logger_t *logger; /* what a terminal or a disk does must not hold up poses */
    ale_status_report_t report;
};

static void take_odometry(void *user, const ale_odometry_t *sample)
{
    ale_exchange_t *exchange = ((ale_telemetry_t *)user)->exchange;
    ale_odometry_t *slot = ale_ring_reserve(exchange->odometry);
    if (slot) {
        ale_odometry_t inside = *sample;
        inside.stamp_us = ale_clock_from_utime(&exchange->clock, sample->stamp_us);
        *slot = inside;
        ale_ring_commit(exchange->odometry);
        ale_recorder_odometry(exchange->recorder, ale_ring_committed(exchange->odometry) - 1, &inside);
    }
}

/* For those who look where the robot goes: without what the scanner sees of the robot itself. */
static void show_scan(ale_telemetry_t *telemetry, const ale_result_t *result)
{
    ale_exchange_t *exchange = telemetry->exchange;
    const ale_pipeline_config_t *pipeline = &telemetry->config->pipeline;
    ale_scan_t *scan = ale_snapshot_back(exchange->drive_scan);
    *scan = result->scan;
    ale_scan_mask(scan, pipeline->blind, pipeline->blind_count);
    if (exchange->explore) {
        ale_explore_take(exchange->explore, scan, &result->estimate);
    }
    ale_snapshot_publish(exchange->drive_scan);
}

static void send_scan(ale_telemetry_t *telemetry, const ale_result_t *result)
{
    const ale_config_t *config = telemetry->config;
    const int64_t utime = ale_clock_to_utime(&telemetry->exchange->clock, result->estimate.stamp_us);
    ale_bus_send_features(telemetry->bus, &result->features, utime, result->estimate.scan,
                          config->pipeline.sensor);
    if (config->keys[0] != '\0') {
        show_scan(telemetry, result);
    }
    if (ale_commands_publish_scan(telemetry->commands)) {
        ale_bus_send_scan(telemetry->bus, &result->scan, utime, result->estimate.scan,
                          config->pipeline.sensor);
    }
    if (config->publish_bot_core) {
        ale_bus_send_bot_lidar(telemetry->bus, &result->scan, utime);
    }
}

static void send_result(ale_telemetry_t *telemetry, const ale_result_t *result)
{
    const ale_clock_t *clock = &telemetry->exchange->clock;
    ale_pose_report_t report = {
        .estimate = result->estimate,
        .first_beam_us = ale_clock_to_utime(clock, result->first_beam_us),
        .arrival_us = ale_clock_to_utime(clock, result->arrival_us),
        .sent_us = ale_clock_to_utime(clock, ale_clock_now_us(clock)),
    };
    report.estimate.stamp_us = ale_clock_to_utime(clock, result->estimate.stamp_us);
    memcpy(report.stage_ns, result->stage_ns, sizeof report.stage_ns);
    memcpy(report.stage_start_ns, result->stage_start_ns, sizeof report.stage_start_ns);
    memcpy(report.stage_end_ns, result->stage_end_ns, sizeof report.stage_end_ns);
    ale_bus_send_pose(telemetry->bus, &report);
    telemetry->pose = result->estimate.map;
    telemetry->epoch = result->estimate.epoch;
    const int64_t latency_us = ale_clock_now_us(clock) - result->arrival_us;
    ale_statistics_add(&telemetry->statistics, result, ale_clock_real_ns(clock, latency_us));
    if (telemetry->config->publish_bot_core) {
        ale_bus_send_bot_pose(telemetry->bus, &report);
    }
    if (result->has_scan) {
        send_scan(telemetry, result);
    }
}

/* A pose that was lost or came late is worth a flight recording. */
static void record_result(ale_telemetry_t *telemetry, const ale_result_t *result)
{
    ale_recorder_t *recorder = telemetry->exchange->recorder;
    if (result->corrected) {
        ale_recorder_correction(recorder, result->estimate.stamp_us, result->estimate.scan,
                                result->correction);
    }
    ale_recorder_result(recorder, result);
    if (telemetry->statistics.poses > 0 && telemetry->statistics.state != ALE_STATE_LOST &&
        result->estimate.state == ALE_STATE_LOST) {
        ale_recorder_trigger(recorder, ALE_RECORD_FAULT);
    }
    if (result->late != telemetry->statistics.late) {
        ale_recorder_trigger(recorder, ALE_RECORD_DEADLINE);
    }
}

static void send_results(ale_telemetry_t *telemetry)
{
    ale_ring_t *results = telemetry->exchange->results;
    for (uint32_t ready = ale_ring_ready(results); ready > 0; ready--) {
        record_result(telemetry, ale_ring_at(results, 0));
        send_result(telemetry, ale_ring_at(results, 0));
        ale_ring_release(results);
    }
}

static void watch_scanner(ale_telemetry_t *telemetry)
{
    bool fresh = false;
    telemetry->health = ale_snapshot_newest(telemetry->exchange->health, &fresh);
    char line[ALE_SUPERVISOR_LINE];
    const ale_link_t before = telemetry->supervisor.link;
    if (fresh && ale_supervisor_watch(&telemetry->supervisor, telemetry->health, line)) {
        char words[sizeof line + 8];
        ale_logger_log(telemetry->logger, line);
        snprintf(words, sizeof words, "STATUS=%s", line);
        ale_service_tell(&telemetry->service, words);
        if (before == ALE_LINK_STREAMING) {
            ale_recorder_trigger(telemetry->exchange->recorder, ALE_RECORD_FAULT);
        }
    }
}

static void send_status(ale_telemetry_t *telemetry)
{
    const ale_clock_t *clock = &telemetry->exchange->clock;
    ale_status_report_t *report = &telemetry->report;
    report->now_us = ale_clock_to_utime(clock, ale_clock_now_us(clock));
    report->boot = telemetry->boot;
    report->realtime = telemetry->realtime.realtime;
    memcpy(report->realtime_detail, telemetry->realtime.text, sizeof report->realtime_detail);
    ale_statistics_report(&telemetry->statistics, report);
    ale_supervisor_report(telemetry->health, ale_clock_now_us(clock), report);
    ale_statistics_counters(&telemetry->statistics, telemetry->health, telemetry->exchange,
                            ale_bus_refused(telemetry->bus), ale_bus_unsent(telemetry->bus), report);
    ale_commands_report(telemetry->commands, &report->operation);
    ale_commands_counters(telemetry->commands, report);
    report->counter[report->counters++] =
        (ale_counter_t){.name = "words_left_out", .value = ale_logger_dropped(telemetry->logger)};
    ale_bus_send_status(telemetry->bus, report);
    telemetry->last_status_ns = ale_rt_now_ns();
    telemetry->news = false;
    telemetry->refusals = false;
}

/* An answer that nobody has heard yet goes out before another may take its place. */
static void take_command(void *user, const uint8_t *bytes, size_t count)
{
    ale_telemetry_t *telemetry = user;
    if (telemetry->news) {
        send_status(telemetry);
    }
    if (!ale_commands_take(telemetry->commands, bytes, count, ale_map_publisher_map(&telemetry->map))) {
        telemetry->refusals = true;
    }
    telemetry->news = ale_commands_news(telemetry->commands);
}

/* The newest pose with the map that it was found in, which is the tracker's; while lost, what was kept before
 * stays. */
static void keep_map(ale_telemetry_t *telemetry)
{
    ale_persistence_t *persistence = telemetry->exchange->persistence;
    if (persistence && telemetry->statistics.state != ALE_STATE_LOST) {
        ale_persistence_offer(persistence, ale_map_publisher_tracked(&telemetry->map), &telemetry->pose);
    }
}

static void wait_for_work(ale_telemetry_t *telemetry)
{
    ale_exchange_t *exchange = telemetry->exchange;
    int64_t wait_ns = ale_max64(telemetry->next_status_ns - ale_rt_now_ns(), 0);
    if (ale_map_publisher_is_busy(&telemetry->map)) {
        wait_ns = ale_min64(wait_ns, ALE_MAP_PART_NS);
    }
    wait_ns = ale_exchange_result_wait_ns(exchange, wait_ns);
    if (ale_wake_wait_or_read(exchange->under_way, ale_bus_descriptor(telemetry->bus), wait_ns)) {
        ale_bus_receive(telemetry->bus, 0);
    }
}

static void work(ale_telemetry_t *telemetry)
{
    send_results(telemetry);
    watch_scanner(telemetry);
    const int64_t now_ns = ale_rt_now_ns();
    ale_map_publisher_work(&telemetry->map, telemetry->epoch, now_ns);
    ale_commands_work(telemetry->commands);
    telemetry->news = ale_commands_news(telemetry->commands) || telemetry->news;
    if (telemetry->news || telemetry->refusals) {
        telemetry->next_status_ns =
            ale_min64(telemetry->next_status_ns, telemetry->last_status_ns + NEWS_PERIOD_NS);
    }
    if (now_ns >= telemetry->next_status_ns) {
        send_status(telemetry);
        telemetry->next_status_ns = ale_max64(telemetry->next_status_ns + STATUS_PERIOD_NS, now_ns);
    }
    if (now_ns >= telemetry->next_keep_ns) {
        keep_map(telemetry);
        telemetry->next_keep_ns = now_ns + (int64_t)telemetry->config->keep_seconds * NS_PER_S;
    }
    ale_service_feed(&telemetry->service, ale_heartbeat_beats(telemetry->exchange->heartbeat), now_ns);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_telemetry_t *telemetry = user;
    if (ale_bus_on_odometry(telemetry->bus, take_odometry, telemetry) < 0) {
        ale_logger_log(telemetry->logger, "LCM refuses the subscription of odometry: going on without");
    }
    if (ale_bus_on_command(telemetry->bus, take_command, telemetry) < 0) {
        ale_logger_log(telemetry->logger, "LCM refuses the subscription of commands: none will be taken");
    }
    sem_post(&telemetry->listening);
    while (!ale_rt_task_stopping(self)) {
        wait_for_work(telemetry);
        work(telemetry);
    }
    work(telemetry);
    ale_map_publisher_finish(&telemetry->map, telemetry->epoch);
    keep_map(telemetry);
    send_status(telemetry);
}

static int64_t boot_nonce(void)
{
    int64_t nonce = 0;
    if (getrandom(&nonce, sizeof nonce, 0) != (ssize_t)sizeof nonce) {
        nonce = ale_rt_now_ns();
    }
    return nonce & INT64_MAX;
}

static int start_commands(ale_telemetry_t *telemetry, const ale_keys_t *keys)
{
    telemetry->storage = ale_map_storage_start(telemetry->config, telemetry->exchange);
    if (telemetry->storage) {
        telemetry->commands = ale_commands_create(telemetry->config, keys, telemetry->boot,
                                                  telemetry->exchange, telemetry->storage);
    }
    return telemetry->commands ? 0 : -1;
}

ale_telemetry_t *ale_telemetry_start(const ale_config_t *config, const ale_keys_t *keys,
                                     ale_exchange_t *exchange, ale_bus_t *bus,
                                     const ale_rt_report_t *realtime)
{
    ale_telemetry_t *telemetry = calloc(1, sizeof *telemetry);
    if (!telemetry) {
        return NULL;
    }
    telemetry->config = config;
    telemetry->exchange = exchange;
    telemetry->bus = bus;
    ale_map_publisher_init(&telemetry->map, exchange, bus);
    telemetry->realtime = *realtime;
    telemetry->boot = boot_nonce();
    ale_service_open(&telemetry->service);
    telemetry->next_status_ns = ale_rt_now_ns() + STATUS_PERIOD_NS;
    sem_init(&telemetry->listening, 0, 0);
    telemetry->logger = ale_logger_start(stderr);
    if (telemetry->logger && start_commands(telemetry, keys) == 0) {
        telemetry->task = ale_rt_task_start(&(ale_rt_task_config_t){
            .name = "ale-telemetry", .kind = ALE_RT_ORDINARY, .body = run, .user = telemetry});
    }
    if (!telemetry->task) {
        ale_telemetry_stop(telemetry);
        return NULL;
    }
    while (sem_wait(&telemetry->listening) < 0 && errno == EINTR) {
    }
    return telemetry;
}

void ale_telemetry_stop(ale_telemetry_t *telemetry)
{
    if (!telemetry) {
        return;
    }
    if (telemetry->task) {
        ale_rt_task_stop(telemetry->task);
        ale_wake_post(telemetry->exchange->under_way);
        ale_rt_task_join(telemetry->task);
    }
    ale_map_storage_stop(telemetry->storage);
    ale_commands_destroy(telemetry->commands);
    ale_service_close(&telemetry->service);
    ale_logger_stop(telemetry->logger);
    sem_destroy(&telemetry->listening);
    free(telemetry);
}
