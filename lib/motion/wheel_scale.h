/* The factor by which wheels tell the distance wrong (the diameter of the wheels), learnt on line.
 *
 * factor = found / counted distance, sums over scans whose displacement registration knows. Errors of
 * matching cancel where one way goes on from the other, and leave those of its two ends; each way that begins
 * anew, or back, adds its own two. So the estimate is that of least squares with a prior: an excess e found
 * beyond the counted way c, with the variance v of the ends, gives 1 + e c / (c^2 + v / sigma^2). A robot
 * that turns on the spot, or is seen once in a while, teaches little, however often. One owner; constant work
 * a call. */
#ifndef ALE_MOTION_WHEEL_SCALE_H
#define ALE_MOTION_WHEEL_SCALE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int32_t sigma_ppm;  /* of the factor, before anything is learnt; at least 2000 */
    int64_t counted_um; /* forward distance by odometry while both were good; forgotten slowly */
    int64_t excess_um;  /* what registration found beyond it */
    int64_t erred_um;   /* part of that which one sigma of the factor has made */
    int64_t ends_um2;   /* variance of the excess by errors of matching */
    bool begun;
    int64_t end_us; /* of the last way, */
    bool back;      /* which went backwards */
} ale_wheel_scale_t;

/* A way between two scans, as long as registration knows it. */
typedef struct {
    int64_t from_us; /* stamps of the scans */
    int64_t to_us;
    int64_t found_um;   /* forward displacement by registration, */
    int64_t counted_um; /* and by odometry; each within +-100 m */
    int64_t erred_um;   /* part of found_um that one sigma of the factor has made
                         * (match/odometry_scale_error.h) */
} ale_wheel_lesson_t;

/* sigma_ppm: 0..500000. */
void ale_wheel_scale_init(ale_wheel_scale_t *scale, int32_t sigma_ppm);

/* Learns from one way. Displacements that differ by a third are ignored: wheels that spin, or a wrong match.
 */
void ale_wheel_scale_learn(ale_wheel_scale_t *scale, const ale_wheel_lesson_t *lesson);

/* A distance by odometry, um, as it is expected to be. */
int32_t ale_wheel_scale_apply(const ale_wheel_scale_t *scale, int64_t counted_um);

/* One sigma of the factor, parts per million. */
int64_t ale_wheel_scale_sigma_ppm(const ale_wheel_scale_t *scale);

/* One sigma of the part of the factor's error that is the same in every scan, parts per million. */
int64_t ale_wheel_scale_error_ppm(const ale_wheel_scale_t *scale);

#endif
