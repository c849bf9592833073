/* Lag between scanner and wheels, estimated on line.
 *
 * lag: a sample of the wheels stamped t was really taken at t + lag. For a row of candidate lags the turn
 * between two samples of the wheels is compared with the turn that scan matching found over the same
 * interval, moved by the lag; the sum of squared differences is lowest at the lag (the least-squares form
 * of the correlation), and how sharp its minimum is tells how well the lag is known. It is the headings of
 * the scans that are interpolated, not those of the wheels: these are noisy, and the mean of two noisy
 * samples fits better wherever the truth lies. Intervals without a turn say nothing and are left out; a
 * prior keeps the answer until something turned. One owner; constant work a sample. */
#ifndef ALE_MOTION_LAG_H
#define ALE_MOTION_LAG_H

#include <stdint.h>

#include "motion/odometry.h"

enum {
    ALE_LAG_CANDIDATES = 21,
    ALE_LAG_FIRST_US = -100000,
    ALE_LAG_STEP_US = 20000,
    ALE_LAG_PRIOR_SIGMA_US = 80000,
    ALE_LAG_HEADINGS = 16 /* scans that are remembered */
};

typedef struct {
    int64_t stamp_us;
    uint32_t theta_bam;
    int32_t turn_urad_tick; /* velocity */
} ale_heading_t;

typedef struct {
    ale_heading_t heading[ALE_LAG_HEADINGS]; /* ring, stamps ascending without gaps */
    uint32_t first;
    uint32_t count;
    int64_t done_us; /* stamp of the sample of the wheels up to which all is counted */
    int64_t cost_urad2[ALE_LAG_CANDIDATES];
    int64_t weight_q16; /* intervals counted, older ones less */
    int32_t prior_us;
    int32_t lag_us;
    int32_t sigma_us; /* one sigma of lag_us */
} ale_lag_t;

void ale_lag_init(ale_lag_t *lag, int32_t prior_us);

/* Adds heading and turn rate by a well registered scan. A gap of more than 350 ms clears the headings. */
void ale_lag_add_heading(ale_lag_t *lag, const ale_heading_t *heading);

/* Turns the headings with the map. */
void ale_lag_turn(ale_lag_t *lag, uint32_t turn_bam);

/* Compares the odometry samples that the headings now cover, four at most; updates lag_us and sigma_us. */
void ale_lag_update(ale_lag_t *lag, const ale_wheels_t *wheels);

#endif
