#include "lcm/sender_clock.h"

#include "base/fixed.h"

/* Real microseconds. */
enum {
    BLOCK_US = 1000000,
    SAME_US = 100000,  /* two clocks are one, and a message may take so long */
    SLACK_US = 10000,  /* by which the least delay may change before a drift is believed */
    AHEAD_US = 5000,   /* by which a stamp may be ahead: how well two clocks are set alike */
    STEP_US = 500000,  /* stamps and arrivals that disagree by more do not belong to one clock ... */
    LATE_US = 2000000, /* ... unless the stamps go on, and the messages were held up so long at most */
    WITNESS_US = 200000,
    WITNESSES = 3
};

static int64_t scaled(const ale_sender_clock_t *clock, int64_t real_us)
{
    return ale_mul_div(real_us, clock->scale_ppm, 1000000);
}

void ale_sender_clock_init(ale_sender_clock_t *clock, int32_t scale_ppm)
{
    *clock = (ale_sender_clock_t){.scale_ppm = scale_ppm};
}

static void add_sample(ale_sender_clock_t *clock, int64_t raw_us, int64_t arrival_us)
{
    if (clock->blocks_seen == 0 || arrival_us - clock->block_begin_us >= scaled(clock, BLOCK_US)) {
        clock->block_begin_us = arrival_us;
        clock->least_us[clock->blocks_seen % ALE_SENDER_BLOCKS] = raw_us;
        clock->blocks_seen++;
        return;
    }
    int64_t *least_us = &clock->least_us[(clock->blocks_seen - 1) % ALE_SENDER_BLOCKS];
    *least_us = ale_min64(*least_us, raw_us);
}

static int64_t least_of_window(const ale_sender_clock_t *clock)
{
    int64_t least_us = INT64_MAX;
    for (uint64_t k = 0; k < ALE_SENDER_BLOCKS && k < clock->blocks_seen; k++) {
        least_us = ale_min64(least_us, clock->least_us[k]);
    }
    return least_us;
}

static bool is_same(const ale_sender_clock_t *clock, int64_t raw_us)
{
    return raw_us >= -scaled(clock, AHEAD_US) && raw_us <= scaled(clock, SAME_US);
}

static void begin(ale_sender_clock_t *clock, int64_t raw_us, int64_t arrival_us)
{
    clock->same = is_same(clock, raw_us);
    clock->offset_us = clock->same ? 0 : raw_us;
    clock->most_us = scaled(clock, clock->same ? SAME_US : SLACK_US);
    clock->blocks_seen = 0;
    add_sample(clock, raw_us, arrival_us);
}

/* Down at once, since nothing arrives before it was sent; up when all messages of the window took longer than
 * is believed. What they take is known after the first window. */
static void follow(ale_sender_clock_t *clock)
{
    const int64_t least_us = least_of_window(clock);
    const int64_t delay_us = least_us - clock->offset_us;
    if (clock->blocks_seen == ALE_SENDER_BLOCKS + 1) {
        clock->most_us = ale_min64(clock->most_us, ale_max64(delay_us, 0) + scaled(clock, SLACK_US));
    }
    if (delay_us < 0) {
        clock->offset_us = clock->same && is_same(clock, least_us) ? 0 : least_us;
    } else if (delay_us > clock->most_us) {
        clock->offset_us = least_us - clock->most_us;
    }
}

static bool belongs(const ale_sender_clock_t *clock, int64_t stamp_us, int64_t delay_us)
{
    const int64_t passed_us = stamp_us - clock->stamp_us;
    const bool goes_on = passed_us > 0 && passed_us < scaled(clock, STEP_US);
    return ale_abs64(delay_us) < scaled(clock, STEP_US) ||
           (goes_on && delay_us > 0 && delay_us < scaled(clock, LATE_US));
}

/* Whether enough messages have agreed on another offset. One that repeats a stamp says nothing of a clock. */
static bool is_stepped(ale_sender_clock_t *clock, int64_t raw_us, int64_t arrival_us)
{
    const bool agrees = ale_abs64(raw_us - clock->witnessed_us) < scaled(clock, STEP_US);
    if (clock->witnesses == 0 || !agrees) {
        clock->witnesses = 0;
        clock->witnesses_since_us = arrival_us;
        clock->witnessed_us = raw_us;
    }
    clock->witnesses++;
    clock->witnessed_us = ale_min64(clock->witnessed_us, raw_us);
    return clock->witnesses >= WITNESSES &&
           arrival_us - clock->witnesses_since_us >= scaled(clock, WITNESS_US);
}

static void step(ale_sender_clock_t *clock, int64_t arrival_us)
{
    const int64_t before_us = clock->offset_us;
    begin(clock, clock->witnessed_us, arrival_us);
    clock->steps++;
    clock->step_us = before_us - clock->offset_us;
}

bool ale_sender_clock_take(ale_sender_clock_t *clock, int64_t stamp_us, int64_t arrival_us, int64_t *time_us)
{
    const int64_t raw_us = arrival_us - stamp_us;
    if (!clock->started) {
        clock->started = true;
        begin(clock, raw_us, arrival_us);
    } else if (belongs(clock, stamp_us, raw_us - clock->offset_us)) {
        add_sample(clock, raw_us, arrival_us);
        follow(clock);
    } else if (stamp_us != clock->stamp_us && is_stepped(clock, raw_us, arrival_us)) {
        step(clock, arrival_us);
    } else {
        clock->arrival_us = arrival_us;
        return false;
    }
    clock->witnesses = 0;
    clock->stamp_us = stamp_us;
    clock->arrival_us = arrival_us;
    *time_us = stamp_us + clock->offset_us;
    return true;
}
