#include "telemetry/status_publisher.h"

#include <string.h>

#include "base/fixed.h"
#include "telemetry/supervisor.h"

#define PERIOD_NS 1000000000
#define NEWS_PERIOD_NS 50000000 /* between statuses that tell of commands */

void ale_status_publisher_send(ale_status_publisher_t *publisher)
{
    const ale_clock_t *clock = &publisher->exchange->clock;
    ale_status_report_t *report = &publisher->report;
    report->now_us = ale_clock_to_utime(clock, ale_clock_now_us(clock));
    report->boot = publisher->boot;
    report->realtime = publisher->realtime.realtime;
    memcpy(report->realtime_detail, publisher->realtime.text, sizeof report->realtime_detail);
    ale_statistics_report(publisher->statistics, report);
    ale_supervisor_report(publisher->health, ale_clock_now_us(clock), publisher->statistics->wheel_fault,
                          report);
    ale_statistics_counters(publisher->statistics, publisher->health, publisher->exchange,
                            ale_bus_unsent(publisher->bus), report);
    ale_odometry_intake_counters(publisher->odometry, ale_bus_refused(publisher->bus), report);
    ale_commands_report(publisher->commands, &report->operation);
    ale_commands_counters(publisher->commands, report);
    report->counter[report->counters++] =
        (ale_counter_t){.name = "words_left_out", .value = ale_logger_dropped(publisher->logger)};
    const ale_lcm_dropped_t dropped = ale_bus_dropped(publisher->bus);
    report->counter[report->counters++] =
        (ale_counter_t){.name = "datagrams_refused", .value = dropped.malformed};
    report->counter[report->counters++] =
        (ale_counter_t){.name = "datagrams_unheard", .value = dropped.unheard};
    report->counter[report->counters++] = (ale_counter_t){
        .name = "other_speakers", .value = ale_other_speakers_count(publisher->others, ale_rt_now_ns())};
    ale_bus_send_status(publisher->bus, report);
    publisher->others->self.now_us = report->now_us;
    ale_bus_send_speaker(publisher->bus, &publisher->others->self);
    publisher->last_ns = ale_rt_now_ns();
    publisher->news = false;
    publisher->refusals = false;
}

void ale_status_publisher_take_command(ale_status_publisher_t *publisher, const uint8_t *bytes, size_t count,
                                       const ale_map_t *newest_map)
{
    if (publisher->news) {
        ale_status_publisher_send(publisher);
    }
    if (!ale_commands_take(publisher->commands, bytes, count, newest_map)) {
        publisher->refusals = true;
    }
    publisher->news = ale_commands_news(publisher->commands);
}

void ale_status_publisher_work(ale_status_publisher_t *publisher, int64_t now_ns)
{
    publisher->news = ale_commands_news(publisher->commands) || publisher->news;
    if (publisher->news || publisher->refusals) {
        publisher->next_ns = ale_min64(publisher->next_ns, publisher->last_ns + NEWS_PERIOD_NS);
    }
    if (now_ns >= publisher->next_ns) {
        ale_status_publisher_send(publisher);
        publisher->next_ns = ale_max64(publisher->next_ns + PERIOD_NS, now_ns);
    }
}
