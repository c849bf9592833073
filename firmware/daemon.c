#include "daemon.h"

#include <stdlib.h>

#include "acquire/acquire.h"
#include "estimate/estimate.h"
#include "exchange/exchange.h"
#include "lcm/bus.h"
#include "mapping/map_drawer.h"
#include "mapping/mapper_thread.h"
#include "mapping/persistence.h"
#include "mapping/start_map.h"
#include "mapping/tile_thread.h"
#include "operator/drive.h"
#include "operator/explore_thread.h"
#include "realtime/rt.h"
#include "recorder/recorder.h"
#include "system/log_line.h"
#include "system/service.h"
#include "telemetry/telemetry.h"

struct ale_daemon {
    const ale_options_t *options;
    bool realtime_started;
    bool realtime; /* as reported at start */
    bool exchange_open;
    ale_exchange_t exchange;
    ale_recorder_t *recorder;
    ale_persistence_t *persistence;
    ale_service_t service;
    ale_bus_t *bus;
    ale_estimator_t *estimator;
    ale_rt_task_t *estimate;
    ale_tile_loader_t *tile_loader; /* of a map of tiles; else NULL */
    ale_tile_thread_t *tiles;
    ale_mapper_thread_t *mapper;
    ale_map_drawer_t *drawer;
    ale_acquire_t *acquire;
    ale_telemetry_t *telemetry;
    ale_drive_t *drive;
};

static int fail(int exit_code, const char *reason)
{
    fprintf(stderr, "ale-slamd: %s\n", reason);
    return exit_code;
}

static int prepare(ale_daemon_t *daemon)
{
    const ale_config_t *config = &daemon->options->config;
    const ale_rt_config_t realtime = {
        .priority = config->priority, .cpu = config->cpu, .lock_memory = config->lock_memory};
    ale_rt_report_t report;
    if (ale_rt_start(&realtime, &report) < 0) {
        return fail(2, report.text);
    }
    daemon->realtime_started = true;
    char error[ALE_BUS_ERROR];
    daemon->bus = ale_bus_open_early(config->lcm_url, config->lcm_prefix, error);
    if (!daemon->bus) {
        return fail(1, error);
    }
    if (daemon->options->vouches) {
        ale_bus_vouch(daemon->bus, &daemon->options->own_key, daemon->options->scale_ppm);
    }
    if (ale_exchange_open(&daemon->exchange, ale_clock_start(daemon->options->scale_ppm)) < 0) {
        return fail(1, "out of memory");
    }
    daemon->exchange_open = true;
    daemon->estimator = ale_estimator_create(config, &daemon->exchange);
    if (!daemon->estimator) {
        return fail(2, "the configuration of [extract], [noise] or [odometry] is refused by the core");
    }
    if (ale_start_map_load(config, daemon->estimator, &daemon->tile_loader) < 0) {
        return 2;
    }
    daemon->exchange.has_tiles = daemon->tile_loader != NULL;
    return 0;
}

/* What writes to disk, before those who tell it anything. */
static int start_writers(ale_daemon_t *daemon)
{
    const ale_config_t *config = &daemon->options->config;
    const bool record = config->recorder_folder[0] != '\0';
    const bool keep = config->keep[0] != '\0';
    daemon->recorder = record ? ale_recorder_start(config) : NULL;
    daemon->persistence = keep ? ale_persistence_start(config->keep) : NULL;
    daemon->exchange.recorder = daemon->recorder;
    daemon->exchange.persistence = daemon->persistence;
    const bool started = (daemon->recorder || !record) && (daemon->persistence || !keep);
    return started ? 0 : fail(1, "no memory or no thread for the flight recorder or for what is kept");
}

static bool takes_commands(const ale_daemon_t *daemon)
{
    return daemon->options->keys.count > 0;
}

/* Those who read what the estimate task writes, and the task itself. */
static bool start_estimate_and_mapping(ale_daemon_t *daemon)
{
    ale_exchange_t *exchange = &daemon->exchange;
    daemon->estimate = ale_rt_task_start(&(ale_rt_task_config_t){
        .name = "ale-estimate", .kind = ALE_RT_HARD, .body = ale_estimator_run, .user = daemon->estimator});
    if (!daemon->estimate) {
        return false;
    }
    if (takes_commands(daemon)) {
        exchange->explore = ale_explore_start(&daemon->options->config, exchange);
    }
    daemon->mapper = ale_mapper_thread_start(exchange);
    daemon->drawer = ale_map_drawer_start(exchange);
    if (daemon->tile_loader) {
        daemon->tiles = ale_tile_thread_start(exchange, daemon->tile_loader);
    }
    return daemon->mapper && daemon->drawer && (daemon->tiles || !daemon->tile_loader) &&
           (exchange->explore || !takes_commands(daemon));
}

/* What was got of real time, for people and for ALE_STATUS. */
static ale_rt_report_t tell_realtime(ale_daemon_t *daemon)
{
    ale_rt_report_t report;
    ale_rt_report(&report);
    daemon->realtime = report.realtime;
    ale_log_line("%s: %s", report.realtime ? "real time" : "real time degraded", report.text);
    return report;
}

/* Who takes commands should say who he is. */
static void tell_unvouched(const ale_daemon_t *daemon)
{
    if (takes_commands(daemon) && !daemon->options->vouches) {
        ale_log_line(
            "no key of its own: operators cannot know whether its status is its own (ale-keys --own)");
    }
}

static bool start_telemetry_and_drive(ale_daemon_t *daemon, const ale_rt_report_t *realtime)
{
    const ale_config_t *config = &daemon->options->config;
    daemon->telemetry =
        ale_telemetry_start(config, &daemon->options->keys, &daemon->exchange, daemon->bus, realtime);
    if (daemon->telemetry && takes_commands(daemon)) {
        const ale_drive_key_t *key = daemon->options->keyed ? &daemon->options->drive_key : NULL;
        daemon->drive = ale_drive_start(config, key, &daemon->exchange);
    }
    return daemon->telemetry && (daemon->drive || !takes_commands(daemon));
}

/* The readers first, so that nothing fills up and no pose waits; telemetry after those of whom it tells what
 * they got, and before the scanner is spoken to: the bus may take a second to be heard. */
static int start_tasks(ale_daemon_t *daemon)
{
    const bool estimating = start_estimate_and_mapping(daemon);
    const ale_rt_report_t report = tell_realtime(daemon);
    tell_unvouched(daemon);
    if (estimating && start_telemetry_and_drive(daemon, &report)) {
        daemon->acquire = ale_acquire_start(&daemon->options->config, &daemon->exchange);
    }
    return daemon->acquire ? 0 : fail(1, "threads cannot be started");
}

ale_daemon_t *ale_daemon_start(const ale_options_t *options, int *exit_code)
{
    ale_daemon_t *daemon = calloc(1, sizeof *daemon);
    if (!daemon) {
        *exit_code = fail(1, "out of memory");
        return NULL;
    }
    daemon->options = options;
    ale_service_open(&daemon->service);
    *exit_code = prepare(daemon);
    if (*exit_code == 0) {
        *exit_code = start_writers(daemon);
    }
    if (*exit_code == 0) {
        *exit_code = start_tasks(daemon);
    }
    if (*exit_code != 0) {
        ale_daemon_stop(daemon);
        return NULL;
    }
    ale_service_tell(&daemon->service, "READY=1");
    return daemon;
}

static void stop_estimate(ale_daemon_t *daemon)
{
    if (daemon->estimate) {
        ale_rt_task_stop(daemon->estimate);
        ale_rt_release_post(daemon->exchange.arrived);
        ale_rt_task_join(daemon->estimate);
    }
}

/* What only shows in the end: a hard task that had to be left to Linux. */
static void tell_lost_realtime(const ale_daemon_t *daemon)
{
    ale_rt_report_t report;
    ale_rt_report(&report);
    if (daemon->realtime && !report.realtime) {
        ale_log_line("real time was not kept: %s", report.text);
    }
}

/* What the computer, or a simulator that ran faster than it, left undone. */
static void tell_shortfall(const ale_daemon_t *daemon)
{
    const ale_shortfall_t s = ale_estimator_shortfall(daemon->estimator);
    if (s.overloaded > 0 || s.corrections_late > 0 || s.tiles_late > 0) {
        ale_log_line(
            "this computer did not keep up: %u of %u scans set aside for newer ones, %u corrections of the "
            "map late, %u pieces of tiles late",
            s.overloaded, s.scans, s.corrections_late, s.tiles_late);
    }
}

void ale_daemon_stop(ale_daemon_t *daemon)
{
    ale_drive_stop(daemon->drive);
    ale_service_tell(&daemon->service, "STOPPING=1");
    ale_acquire_stop(daemon->acquire);
    stop_estimate(daemon);
    ale_tile_thread_stop(daemon->tiles);
    ale_tile_loader_close(daemon->tile_loader);
    ale_mapper_thread_stop(daemon->mapper);
    ale_map_drawer_stop(daemon->drawer);
    ale_telemetry_stop(daemon->telemetry);
    ale_explore_stop(daemon->exchange.explore);
    ale_recorder_stop(daemon->recorder);
    ale_persistence_stop(daemon->persistence);
    if (daemon->estimator) {
        tell_shortfall(daemon);
    }
    ale_estimator_destroy(daemon->estimator);
    if (daemon->exchange_open) {
        ale_exchange_close(&daemon->exchange);
    }
    ale_bus_close(daemon->bus);
    if (daemon->realtime_started) {
        tell_lost_realtime(daemon);
        ale_rt_stop();
    }
    ale_service_close(&daemon->service);
    free(daemon);
}

void ale_daemon_record(ale_daemon_t *daemon)
{
    ale_recorder_trigger(daemon->recorder, ALE_RECORD_COMMAND);
}
