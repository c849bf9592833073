#include "motion/timestamp_filter.h"

#include "base/fixed.h"

enum {
    HELD_UP_MOST_US = 4000000, /* two stamps that a queue has held up may be farther apart */
    LEARN_SCANS = 8,           /* scans whose stamps give the first idea of the period */
    GAIN_LEAST = 24,           /* the loop forgets after about so many scans */
    EVEN_US = 2000,            /* stamps that jitter less than this are right as they are */
    PERIOD_PARTS = 4,        /* beyond a quarter of the period they do not tell how many turns have passed */
    PERIOD_MOST_US = 250000, /* a log that holds but some of the mirror's turns has no pace */
    /* Mean squares: stamps that are late by chance are off the pace by half of what the times between them
     * are off the period; times that vary by themselves walk off it, by GAIN_LEAST / 2 of that and more. */
    WALK_PARTS = 4,
    WALK_SCANS = 128,
    DENSE_MOST_US = 500000, /* scanners turn at 5 Hz and more; computers miss some */
    USUAL_SCANS = 16,
    UNEVEN_SCANS = 64,
    UNEVEN_SIGMAS = 4
};

void ale_timestamp_filter_init(ale_timestamp_filter_t *timestamp_filter)
{
    *timestamp_filter = (ale_timestamp_filter_t){0};
}

static void restart(ale_timestamp_filter_t *p, int64_t stamp_us)
{
    *p = (ale_timestamp_filter_t){.scans = 1,
                                  .stamp_us = stamp_us,
                                  .even_us = stamp_us,
                                  .usual_us = p->usual_us,
                                  .usual_before_us = p->usual_before_us,
                                  .uneven2_us2 = p->uneven2_us2,
                                  .off_us = p->off_us};
}

/* First scans: the period is their mean distance, the instants are the stamps. */
static void learn(ale_timestamp_filter_t *p, int64_t stamp_us)
{
    const int64_t whole_q8_us = p->period_q8_us * (p->scans - 1) + (stamp_us - p->stamp_us) * 256;
    p->period_q8_us = whole_q8_us / p->scans;
    p->even_us = stamp_us;
}

/* Whether stamps jitter so little that they tell how many turns of the mirror have passed. */
static bool tells_turns(const ale_timestamp_filter_t *p)
{
    const int64_t loose_us = p->period_q8_us / 256 / PERIOD_PARTS;
    return p->jitter2_us2 < loose_us * loose_us;
}

/* Whether there is a pace: stamps stay near it, or at least do not walk off it. */
static bool keeps_pace(const ale_timestamp_filter_t *p)
{
    const bool is_known = p->scans > WALK_SCANS;
    const bool walks = p->walk_us2 >= 0;
    return tells_turns(p) || (is_known && !walks);
}

static int64_t mean(int64_t of_before, int64_t now, int64_t count)
{
    return of_before + ale_round_div(now - of_before, count);
}

/* The loop: how many periods have passed, how far the stamp is off, and a part of that for phase and
 * period. */
static void follow(ale_timestamp_filter_t *p, int64_t stamp_us)
{
    const int64_t period_q8 = ale_max64(p->period_q8_us, 256);
    const int64_t passed = ale_max64(ale_round_div((stamp_us - p->even_us) * 256, period_q8), 1);
    const int64_t turns = tells_turns(p) ? passed : 1;
    const int64_t expected_us = p->even_us + turns * period_q8 / 256;
    const int64_t error_us = stamp_us - expected_us;
    const int64_t gap_error_us = error_us + p->even_us - p->stamp_us;
    const int64_t gain = ale_min64(p->scans - LEARN_SCANS + 4, GAIN_LEAST);
    p->even_us = expected_us + ale_round_div(error_us, gain);
    p->period_q8_us += ale_round_div(error_us * 256, gain * gain * 2 * turns);
    const int64_t followed = p->scans - LEARN_SCANS + 1;
    const int64_t jitter_us2 = error_us * error_us;
    p->jitter2_us2 = mean(p->jitter2_us2, jitter_us2, ale_min64(followed, GAIN_LEAST));
    const int64_t still_us2 = WALK_PARTS * gap_error_us * gap_error_us;
    p->walk_us2 = mean(p->walk_us2, jitter_us2 - still_us2, ale_min64(followed, WALK_SCANS));
}

/* What is usual between scans, and how even it is; the last time counts for that with the next one. */
static void note_gap(ale_timestamp_filter_t *p, int64_t dt_us)
{
    p->uneven2_us2 += (p->off_us * p->off_us - p->uneven2_us2) / UNEVEN_SCANS;
    p->usual_before_us = p->usual_us;
    if (p->scans > 0 && dt_us > 0) {
        const int64_t gap_us = ale_min64(dt_us, ALE_SCAN_PERIOD_MAX_US);
        p->off_us = p->usual_us > 0 ? gap_us - p->usual_us : 0;
        p->usual_us += p->usual_us > 0 ? p->off_us / USUAL_SCANS : gap_us;
    }
}

/* Whether a clock was set, or no scan came for a time: not where a queue may have held stamps up. */
static bool is_step(const ale_timestamp_filter_t *p, int64_t dt_us)
{
    const bool learns = p->scans <= LEARN_SCANS;
    const bool held_up = learns || !tells_turns(p);
    const int64_t most_us = held_up ? HELD_UP_MOST_US : ALE_SCAN_PERIOD_MAX_US;
    const int64_t least_us = held_up ? -HELD_UP_MOST_US : 1;
    return dt_us < least_us || dt_us > most_us;
}

/* The pace of a queue that was empty for a time is what it was. */
static void step(ale_timestamp_filter_t *p, int64_t stamp_us)
{
    const bool is_known = p->scans > WALK_SCANS;
    if (is_known && !tells_turns(p)) {
        p->stamp_us = stamp_us;
        p->even_us = stamp_us;
    } else {
        restart(p, stamp_us);
    }
}

int64_t ale_timestamp_filter_instant(ale_timestamp_filter_t *timestamp_filter, int64_t stamp_us)
{
    const int64_t dt_us = stamp_us - timestamp_filter->stamp_us;
    note_gap(timestamp_filter, dt_us);
    if (timestamp_filter->scans == 0 || is_step(timestamp_filter, dt_us)) {
        step(timestamp_filter, stamp_us);
        return stamp_us;
    }
    if (timestamp_filter->scans <= LEARN_SCANS) {
        learn(timestamp_filter, stamp_us);
    } else {
        follow(timestamp_filter, stamp_us);
    }
    timestamp_filter->scans++;
    timestamp_filter->stamp_us = stamp_us;
    const bool is_even =
        timestamp_filter->period_q8_us / 256 < PERIOD_MOST_US && keeps_pace(timestamp_filter);
    const bool jitters = timestamp_filter->jitter2_us2 > (int64_t)EVEN_US * EVEN_US;
    return is_even && jitters ? timestamp_filter->even_us : stamp_us;
}

bool ale_timestamp_filter_is_dense(const ale_timestamp_filter_t *timestamp_filter)
{
    return timestamp_filter->usual_us > 0 && timestamp_filter->usual_us < DENSE_MOST_US;
}

int64_t ale_timestamp_filter_usual_most_us(const ale_timestamp_filter_t *timestamp_filter)
{
    const int64_t uneven_us = (int64_t)ale_isqrt((uint64_t)timestamp_filter->uneven2_us2);
    return timestamp_filter->usual_us + UNEVEN_SIGMAS * uneven_us;
}

bool ale_timestamp_filter_accepts(const ale_timestamp_filter_t *timestamp_filter, int64_t step_us)
{
    return step_us >= (timestamp_filter->usual_us + PERIOD_PARTS - 1) / PERIOD_PARTS;
}
