#include "telemetry/odometry_intake.h"

#include <stdio.h>

#include "base/fixed.h"
#include "recorder/recorder.h"

#define WORD_PERIOD_US 10000000 /* robot's time, as the next */
#define RECENT_US 5000000
#define US_PER_S 1000000

void ale_odometry_intake_init(ale_odometry_intake_t *intake, ale_exchange_t *exchange)
{
    *intake =
        (ale_odometry_intake_t){.exchange = exchange, .clocks = {.scale_ppm = exchange->clock.scale_ppm}};
}

static void hand_on(ale_exchange_t *exchange, const ale_odometry_t *sample)
{
    ale_odometry_t *slot = ale_ring_reserve(exchange->odometry);
    if (slot) {
        *slot = *sample;
        ale_ring_commit(exchange->odometry);
        ale_recorder_odometry(exchange->recorder, ale_ring_committed(exchange->odometry) - 1, sample);
    }
}

void ale_odometry_intake_take(ale_odometry_intake_t *intake, const ale_odometry_t *sample, uint64_t sender)
{
    const ale_clock_t *robot = &intake->exchange->clock;
    const int64_t stamp_us = ale_clock_from_utime(robot, sample->stamp_us);
    ale_odometry_t inside = *sample;
    if (ale_sender_clocks_take(&intake->clocks, sender, stamp_us, ale_clock_now_us(robot),
                               &inside.stamp_us)) {
        hand_on(intake->exchange, &inside);
    }
}

bool ale_odometry_intake_word(ale_odometry_intake_t *intake, char line[ALE_INTAKE_LINE])
{
    const int64_t now_us = ale_clock_now_us(&intake->exchange->clock);
    if (intake->clocks.steps == intake->steps_told || now_us < intake->next_word_us) {
        return false;
    }
    intake->steps_told = intake->clocks.steps;
    intake->next_word_us = now_us + WORD_PERIOD_US;
    const int64_t tenths = ale_round_div(ale_abs64(intake->clocks.step_us), US_PER_S / 10);
    snprintf(line, ALE_INTAKE_LINE, "odometry: the clock of its sender was set by %s%lld.%lld s: followed",
             intake->clocks.step_us < 0 ? "-" : "+", (long long)(tenths / 10), (long long)(tenths % 10));
    return true;
}

void ale_odometry_intake_counters(const ale_odometry_intake_t *intake, ale_bus_refused_t bus_refused,
                                  ale_status_report_t *report)
{
    const int64_t lately_us = ale_clock_now_us(&intake->exchange->clock) - RECENT_US;
    const ale_counter_t counters[] = {
        {"odometry_refused", bus_refused.malformed + bus_refused.unstamped + intake->clocks.refused},
        {"odometry_malformed", bus_refused.malformed},
        {"odometry_unstamped", bus_refused.unstamped},
        {"odometry_misdated", intake->clocks.refused},
        {"odometry_clock_steps", intake->clocks.steps},
        {"odometry_senders", ale_sender_clocks_heard_since(&intake->clocks, lately_us)},
    };
    for (size_t k = 0; k < sizeof counters / sizeof counters[0]; k++) {
        report->counter[report->counters++] = counters[k];
    }
}
