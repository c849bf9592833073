#include "telemetry/result_publisher.h"

#include <string.h>

#include "operator/explore_thread.h"
#include "recorder/recorder.h"

/* The robot has lost its map, also when it goes on in a new one; or wheels began to lie. */
static bool is_new_trouble(const ale_statistics_t *before, const ale_estimate_t *estimate)
{
    const bool lost = before->state != ALE_STATE_LOST && estimate->state == ALE_STATE_LOST;
    return before->poses > 0 &&
           (lost || estimate->maps > before->maps || estimate->wheel_faults > before->wheel_faults);
}

/* Trouble, or a pose that came late, is worth a flight recording. */
static void record_result(const ale_result_publisher_t *publisher, const ale_result_t *result)
{
    ale_recorder_t *recorder = publisher->exchange->recorder;
    const ale_statistics_t *statistics = &publisher->statistics;
    if (result->corrected) {
        ale_recorder_correction(recorder, result->estimate.stamp_us, result->estimate.scan,
                                result->correction);
    }
    ale_recorder_result(recorder, result);
    if (is_new_trouble(statistics, &result->estimate)) {
        ale_recorder_trigger(recorder, ALE_RECORD_FAULT);
    }
    if (result->late != statistics->late) {
        ale_recorder_trigger(recorder, ALE_RECORD_DEADLINE);
    }
}

static void send_pose(ale_result_publisher_t *publisher, const ale_result_t *result)
{
    const ale_clock_t *clock = &publisher->exchange->clock;
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
    ale_bus_send_pose(publisher->bus, &report);
    ale_bus_send_tracking(publisher->bus, &report.estimate);
    const int64_t latency_us = ale_clock_now_us(clock) - result->arrival_us;
    ale_statistics_add(&publisher->statistics, result, ale_clock_real_ns(clock, latency_us));
    if (publisher->config->publish_bot_core) {
        ale_bus_send_bot_pose(publisher->bus, &report);
    }
    publisher->pose = result->estimate.map;
    publisher->epoch = result->estimate.epoch;
    publisher->moves = result->map_moves;
}

static void tell_tracking(ale_result_publisher_t *publisher, const ale_result_t *result)
{
    char line[ALE_TRACKING_LINE];
    const uint32_t lines = result->has_scan ? result->features.line_count : 0;
    if (ale_tracking_watch_take(&publisher->tracking, &result->estimate, lines, line)) {
        ale_logger_log(publisher->logger, line);
    }
}

/* For those who look where the robot goes: without what the scanner sees of the robot itself. */
static void show_scan(const ale_result_publisher_t *publisher, const ale_result_t *result)
{
    ale_exchange_t *exchange = publisher->exchange;
    const ale_pipeline_config_t *pipeline = &publisher->config->pipeline;
    ale_scan_t *scan = ale_snapshot_back(exchange->drive_scan);
    *scan = result->scan;
    ale_scan_mask(scan, pipeline->blind, pipeline->blind_count);
    if (exchange->explore) {
        ale_explore_take(exchange->explore, scan, &result->estimate);
    }
    ale_snapshot_publish(exchange->drive_scan);
}

static void send_scan(const ale_result_publisher_t *publisher, const ale_result_t *result, bool with_scan)
{
    const ale_config_t *config = publisher->config;
    const int64_t utime = ale_clock_to_utime(&publisher->exchange->clock, result->estimate.stamp_us);
    ale_bus_send_features(publisher->bus, &result->features, utime, result->estimate.scan,
                          config->pipeline.sensor);
    if (config->keys[0] != '\0') {
        show_scan(publisher, result);
    }
    if (with_scan) {
        ale_bus_send_scan(publisher->bus, &result->scan, utime, result->estimate.scan,
                          config->pipeline.sensor);
    }
    if (config->publish_bot_core) {
        ale_bus_send_bot_lidar(publisher->bus, &result->scan, utime);
    }
}

void ale_result_publisher_work(ale_result_publisher_t *publisher, bool with_scans)
{
    ale_ring_t *results = publisher->exchange->results;
    for (uint32_t ready = ale_ring_ready(results); ready > 0; ready--) {
        const ale_result_t *result = ale_ring_at(results, 0);
        record_result(publisher, result);
        send_pose(publisher, result);
        tell_tracking(publisher, result);
        if (result->has_scan) {
            send_scan(publisher, result, with_scans);
        }
        ale_ring_release(results);
    }
}
