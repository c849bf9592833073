#include "telemetry/telemetry.h"

#include <errno.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

#include "base/fixed.h"
#include "config/config_model.h"
#include "exchange/wake.h"
#include "mapping/map_storage.h"
#include "mapping/persistence.h"
#include "operator/commands.h"
#include "recorder/recorder.h"
#include "system/async_logger.h"
#include "system/log_line.h"
#include "system/service.h"
#include "telemetry/graph_publisher.h"
#include "telemetry/map_publisher.h"
#include "telemetry/odometry_intake.h"
#include "telemetry/other_speakers.h"
#include "telemetry/plan_publisher.h"
#include "telemetry/realtime_watch.h"
#include "telemetry/result_publisher.h"
#include "telemetry/status_publisher.h"
#include "telemetry/supervisor.h"

#define NS_PER_S 1000000000
#define REALTIME_NS 2000000000
#define SELF_TEST_MS 1000
#define SELF_TEST_AGAIN_MS 50 /* while scans come */

struct ale_telemetry {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    ale_rt_task_t *task;
    sem_t listening; /* posted once, when LCM is heard */
    ale_map_storage_t *storage;
    ale_commands_t *commands;
    ale_supervisor_t supervisor;
    ale_scanner_state_t told; /* of the scanner, by the last status that was due to a change */
    ale_result_publisher_t results;
    ale_odometry_intake_t odometry;
    ale_other_speakers_t others;
    ale_status_publisher_t status;
    ale_realtime_watch_t realtime;
    ale_map_publisher_t map;
    ale_plan_publisher_t plan;
    ale_graph_publisher_t graph;
    int64_t next_keep_ns;
    ale_service_t service;
    ale_logger_t *logger; /* what a terminal or a disk does must not hold up poses */
};

static void take_odometry(void *user, const ale_odometry_t *sample, uint64_t sender)
{
    ale_odometry_intake_take(&((ale_telemetry_t *)user)->odometry, sample, sender);
}

/* Which noise its ranges are taken to have: a preset chosen by mistake shows nowhere else. */
static void tell_preset(ale_telemetry_t *telemetry)
{
    char name[ALE_PRESET_NAME];
    char line[ALE_LOGGER_LINE];
    const bool given = telemetry->config->noise_given != 0;
    ale_config_preset(telemetry->config, telemetry->status.health->identity.model, name);
    snprintf(line, sizeof line, "noise of %s%s; [sensor] model names another", name,
             given ? ", but for what [noise] says" : "");
    ale_logger_log(telemetry->logger, line);
}

static void watch_scanner(ale_telemetry_t *telemetry)
{
    bool fresh = false;
    telemetry->status.health = ale_snapshot_newest(telemetry->exchange->health, &fresh);
    char line[ALE_SUPERVISOR_LINE];
    const ale_link_t before = telemetry->supervisor.link;
    if (ale_supervisor_watch(&telemetry->supervisor, telemetry->status.health, ale_rt_now_ns() / 1000,
                             line)) {
        char words[sizeof line + 8];
        ale_logger_log(telemetry->logger, line);
        snprintf(words, sizeof words, "STATUS=%s", line);
        ale_service_tell(&telemetry->service, words);
        if (telemetry->supervisor.link == ALE_LINK_STREAMING) {
            tell_preset(telemetry);
        }
        if (before == ALE_LINK_STREAMING) {
            ale_recorder_trigger(telemetry->exchange->recorder, ALE_RECORD_FAULT);
        }
    }
    const ale_scanner_state_t state = telemetry->status.health->state;
    telemetry->status.news = telemetry->status.news || state != telemetry->told;
    telemetry->told = state;
}

static void watch_wheels(ale_telemetry_t *telemetry)
{
    char line[ALE_SUPERVISOR_LINE];
    const ale_statistics_t *statistics = &telemetry->results.statistics;
    if (ale_supervisor_watch_wheels(&telemetry->supervisor, statistics->wheel_fault, line)) {
        ale_logger_log(telemetry->logger, line);
    }
}

static void take_speaker(void *user, const ale_speaker_t *speaker)
{
    ale_other_speakers_take(&((ale_telemetry_t *)user)->others, speaker, ale_rt_now_ns());
}

static void watch_others(ale_telemetry_t *telemetry)
{
    char line[ALE_SPEAKERS_LINE];
    if (ale_other_speakers_word(&telemetry->others, ale_rt_now_ns(), line)) {
        ale_logger_log(telemetry->logger, line);
    }
}

static void watch_odometry(ale_telemetry_t *telemetry)
{
    char line[ALE_INTAKE_LINE];
    if (ale_odometry_intake_word(&telemetry->odometry, line)) {
        ale_logger_log(telemetry->logger, line);
    }
}

static void test_bus(ale_telemetry_t *telemetry, int timeout_ms)
{
    if (!ale_bus_hears_itself(telemetry->bus, timeout_ms)) {
        ale_logger_log(
            telemetry->logger,
            "LCM: what is sent does not come back, and commands may not come in: is there a firewall, "
            "an IPAddressDeny of the service, or a route that is missing?");
    }
}

static void watch_realtime(ale_telemetry_t *telemetry)
{
    ale_rt_report_t *report = &telemetry->status.realtime;
    if (ale_realtime_watch_changed(&telemetry->realtime, report)) {
        char line[ALE_LOGGER_LINE];
        snprintf(line, sizeof line, "%s: %.280s", report->realtime ? "real time" : "real time degraded",
                 report->text);
        ale_logger_log(telemetry->logger, line);
        telemetry->status.news = true;
    }
}

static void watch_network(ale_telemetry_t *telemetry)
{
    char line[ALE_SUPERVISOR_LINE];
    const bool has_route = ale_bus_tend(telemetry->bus);
    if (ale_supervisor_watch_network(&telemetry->supervisor, has_route, line)) {
        ale_logger_log(telemetry->logger, line);
        if (has_route) {
            test_bus(telemetry, SELF_TEST_AGAIN_MS);
        }
    }
}

static void watch_motors(ale_telemetry_t *telemetry)
{
    bool fresh = false;
    char line[ALE_SUPERVISOR_LINE];
    const int *status = ale_snapshot_newest(telemetry->exchange->motor_line, &fresh);
    if (ale_supervisor_watch_motors(&telemetry->supervisor, telemetry->config->drive_port, *status, line)) {
        ale_logger_log(telemetry->logger, line);
    }
}

static void take_command(void *user, const uint8_t *bytes, size_t count)
{
    ale_telemetry_t *telemetry = user;
    ale_status_publisher_take_command(&telemetry->status, bytes, count,
                                      ale_map_publisher_map(&telemetry->map));
}

/* The newest pose with the map that it was found in, which is the tracker's; while lost, what was kept before
 * stays. False: the map was moved since it was handed over, or the pose is still of before; both agree within
 * a second. */
static bool keep_map(ale_telemetry_t *telemetry)
{
    ale_persistence_t *persistence = telemetry->exchange->persistence;
    if (!persistence || telemetry->results.statistics.state == ALE_STATE_LOST) {
        return true;
    }
    const ale_tracked_map_t *tracked = ale_map_publisher_tracked(&telemetry->map);
    if (tracked->moves != telemetry->results.moves) {
        return false;
    }
    ale_persistence_offer(persistence, &tracked->map, &telemetry->results.pose);
    return true;
}

static void wait_for_work(ale_telemetry_t *telemetry)
{
    ale_exchange_t *exchange = telemetry->exchange;
    int64_t wait_ns = ale_max64(telemetry->status.next_ns - ale_rt_now_ns(), 0);
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
    ale_result_publisher_work(&telemetry->results, ale_commands_publish_scan(telemetry->commands));
    watch_scanner(telemetry);
    watch_wheels(telemetry);
    watch_odometry(telemetry);
    watch_others(telemetry);
    watch_network(telemetry);
    watch_motors(telemetry);
    watch_realtime(telemetry);
    const int64_t now_ns = ale_rt_now_ns();
    ale_map_publisher_work(&telemetry->map, telemetry->results.epoch, now_ns);
    ale_commands_work(telemetry->commands);
    ale_plan_publisher_work(&telemetry->plan, now_ns);
    ale_graph_publisher_work(&telemetry->graph, now_ns);
    ale_status_publisher_work(&telemetry->status, now_ns);
    if (now_ns >= telemetry->next_keep_ns && keep_map(telemetry)) {
        telemetry->next_keep_ns = now_ns + (int64_t)telemetry->config->keep_seconds * NS_PER_S;
    }
    ale_service_feed(&telemetry->service, ale_heartbeat_beats(telemetry->exchange->heartbeat), now_ns);
}

/* From here on odometry and commands come in. */
static void listen_to_lcm(ale_telemetry_t *telemetry)
{
    if (ale_bus_on_odometry(telemetry->bus, take_odometry, telemetry) < 0) {
        ale_logger_log(telemetry->logger, "LCM refuses the subscription of odometry: going on without");
    }
    if (ale_bus_on_command(telemetry->bus, take_command, telemetry) < 0) {
        ale_logger_log(telemetry->logger, "LCM refuses the subscription of commands: none will be taken");
    }
    (void)ale_bus_on_speaker(telemetry->bus, take_speaker, telemetry); /* goes without */
    watch_network(telemetry);
    if (ale_bus_tend(telemetry->bus)) {
        test_bus(telemetry, SELF_TEST_MS);
    }
    sem_post(&telemetry->listening);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_telemetry_t *telemetry = user;
    watch_scanner(telemetry);
    listen_to_lcm(telemetry);
    while (!ale_rt_task_stopping(self)) {
        wait_for_work(telemetry);
        work(telemetry);
    }
    work(telemetry);
    ale_map_publisher_finish(&telemetry->map, telemetry->results.epoch);
    ale_graph_publisher_finish(&telemetry->graph);
    (void)keep_map(telemetry); /* or what was kept before stays */
    ale_status_publisher_send(&telemetry->status);
}

static int64_t boot_nonce(void)
{
    int64_t nonce = 0;
    if (getrandom(&nonce, sizeof nonce, 0) != (ssize_t)sizeof nonce) {
        nonce = ale_rt_now_ns();
    }
    return nonce & INT64_MAX;
}

/* What the thread works with: where words for people go, and what commands do. */
static bool start_parts(ale_telemetry_t *telemetry, const ale_keys_t *keys, int64_t boot)
{
    telemetry->logger = ale_logger_start(stderr, ale_log_wants_time());
    telemetry->storage = ale_map_storage_start(telemetry->config, telemetry->exchange);
    if (telemetry->logger && telemetry->storage) {
        telemetry->commands =
            ale_commands_create(telemetry->config, keys, boot, telemetry->exchange, telemetry->storage);
    }
    return telemetry->commands != NULL;
}

static void init_publishers(ale_telemetry_t *telemetry, const ale_rt_report_t *realtime, int64_t boot)
{
    telemetry->results = (ale_result_publisher_t){.config = telemetry->config,
                                                  .exchange = telemetry->exchange,
                                                  .bus = telemetry->bus,
                                                  .logger = telemetry->logger};
    ale_other_speakers_init(&telemetry->others, boot, telemetry->config->name);
    ale_odometry_intake_init(&telemetry->odometry, telemetry->exchange);
    ale_map_publisher_init(&telemetry->map, telemetry->exchange, telemetry->bus);
    telemetry->plan = (ale_plan_publisher_t){.exchange = telemetry->exchange, .bus = telemetry->bus};
    telemetry->graph = (ale_graph_publisher_t){.exchange = telemetry->exchange, .bus = telemetry->bus};
    telemetry->status = (ale_status_publisher_t){
        .exchange = telemetry->exchange,
        .bus = telemetry->bus,
        .commands = telemetry->commands,
        .logger = telemetry->logger,
        .statistics = &telemetry->results.statistics,
        .odometry = &telemetry->odometry,
        .others = &telemetry->others,
        .realtime = *realtime,
        .boot = boot,
        .next_ns = ale_rt_now_ns() + NS_PER_S,
    };
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
    ale_service_open(&telemetry->service);
    sem_init(&telemetry->listening, 0, 0);
    const int64_t boot = boot_nonce();
    if (start_parts(telemetry, keys, boot)) {
        init_publishers(telemetry, realtime, boot);
        (void)ale_realtime_watch_start(&telemetry->realtime, ale_rt_report, REALTIME_NS); /* goes without */
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
    ale_realtime_watch_stop(&telemetry->realtime);
    ale_map_storage_stop(telemetry->storage);
    ale_commands_destroy(telemetry->commands);
    ale_service_close(&telemetry->service);
    ale_logger_stop(telemetry->logger);
    sem_destroy(&telemetry->listening);
    free(telemetry);
}
