#include "telemetry/statistics.h"

#include "recorder/recorder.h"

void ale_statistics_add(ale_statistics_t *statistics, const ale_result_t *result, int64_t latency_ns)
{
    statistics->poses++;
    statistics->overloaded = result->overloaded;
    statistics->corrections_late = result->corrections_late;
    statistics->late = result->late;
    statistics->state = result->estimate.state;
    statistics->maps = result->estimate.maps;
    statistics->wheel_fault = result->estimate.wheel_fault;
    statistics->wheel_faults = result->estimate.wheel_faults;
    if (!result->has_scan) {
        return;
    }
    for (int k = 0; k < ALE_STAGES; k++) {
        ale_durations_add(&statistics->stage[k], result->stage_ns[k]);
    }
    ale_durations_add(&statistics->stage[ALE_STAGES], result->total_ns);
    ale_durations_add(&statistics->latency, latency_ns);
}

void ale_statistics_report(const ale_statistics_t *statistics, ale_status_report_t *report)
{
    for (int k = 0; k < ALE_STATUS_STAGES; k++) {
        report->stage_last_ns[k] = statistics->stage[k].last_ns;
        report->stage_p99_ns[k] = ale_durations_quantile(&statistics->stage[k], 990);
        report->stage_worst_ns[k] = statistics->stage[k].worst_ns;
    }
    report->latency_p50_ns = ale_durations_quantile(&statistics->latency, 500);
    report->latency_p99_ns = ale_durations_quantile(&statistics->latency, 990);
    report->latency_worst_ns = statistics->latency.worst_ns;
    report->deadline_misses = statistics->late;
    report->poses = statistics->poses;
    report->state = statistics->state;
}

static void count(ale_status_report_t *report, const char *name, uint64_t value)
{
    report->counter[report->counters] = (ale_counter_t){.name = name, .value = value};
    report->counters++;
}

void ale_statistics_counters(const ale_statistics_t *statistics, const ale_scanner_health_t *health,
                             const ale_exchange_t *exchange, uint64_t bus_unsent, ale_status_report_t *report)
{
    report->counters = 0;
    count(report, "scans_lost", health->scans_lost);
    count(report, "bad_checksum", health->bad_checksum);
    count(report, "bad_frame", health->bad_frame);
    count(report, "repeated", health->repeated);
    count(report, "losses_too_fast", health->losses_too_fast);
    count(report, "garbage_bytes", health->garbage_bytes);
    count(report, "stream_restarts", health->stream_restarts);
    count(report, "resets", health->resets);
    count(report, "reopens", health->reopens);
    count(report, "hardware_faults", health->hardware_faults);
    count(report, "identity_warnings", health->identity_warnings);
    count(report, "maps", statistics->maps);
    count(report, "wheel_faults", statistics->wheel_faults);
    count(report, "overloaded", statistics->overloaded);
    count(report, "corrections_late", statistics->corrections_late);
    count(report, "scan_ring_full", ale_ring_refused(exchange->scans));
    count(report, "result_ring_full", ale_ring_refused(exchange->results));
    count(report, "odometry", ale_ring_committed(exchange->odometry));
    count(report, "odometry_ring_full", ale_ring_refused(exchange->odometry));
    count(report, "messages_unsent", bus_unsent);
    count(report, "flight_recordings", ale_recorder_written(exchange->recorder));
    count(report, "recorder_queue_full", ale_recorder_refused(exchange->recorder));
}
