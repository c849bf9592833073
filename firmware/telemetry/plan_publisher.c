#include "telemetry/plan_publisher.h"

#include "operator/explore_thread.h"

#define PERIOD_NS 1000000000

void ale_plan_publisher_work(ale_plan_publisher_t *publisher, int64_t now_ns)
{
    ale_exchange_t *exchange = publisher->exchange;
    if (!exchange->explore) {
        return;
    }
    ale_plan_report_t *report = &publisher->report;
    const uint32_t number = ale_explore_plan(exchange->explore, report);
    const bool again = report->state != ALE_PLAN_OFF && now_ns >= publisher->next_ns;
    if (number == publisher->told && !again) {
        return;
    }
    report->now_us = ale_clock_to_utime(&exchange->clock, ale_clock_now_us(&exchange->clock));
    ale_bus_send_plan(publisher->bus, report);
    publisher->told = number;
    publisher->next_ns = now_ns + PERIOD_NS;
}
