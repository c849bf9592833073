/* Point landmarks: where the map has no walls, positions of surfaces and small objects, with normals.
 *
 * A set-associative table of 100 mm cells by hash: bounded memory, bounded look-up. A full set replaces its
 * least seen landmark. A landmark is a Kalman filter over the short segments that were associated with it.
 * One owner. */
#ifndef ALE_MAP_LANDMARKS_H
#define ALE_MAP_LANDMARKS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "map/tile_grid.h"

enum {
    ALE_LANDMARK_SETS = 2048,
    ALE_LANDMARK_WAYS = 4,
    ALE_NO_LANDMARK = -1,
    ALE_LANDMARK_CONFIRMED = 3 /* scans; one that fewer have shown may pass by, and determines nothing */
};

typedef struct {
    ale_point_t p; /* map frame */
    uint32_t normal_bam;
    uint32_t last_scan;
    int64_t var_um2; /* along the normal; of a point feature in every direction */
    uint16_t seen;   /* 0: the place is free */
    uint8_t is_point;
    uint8_t map;   /* that it belongs to: see atlas.h */
    uint32_t born; /* scan that saw it first */
} ale_landmark_t;

typedef struct {
    ale_landmark_t landmark[ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS];
    uint8_t selected; /* the map whose landmarks are found */
} ale_landmarks_t;

void ale_landmarks_clear(ale_landmarks_t *landmarks);

/* The nearest landmark within reach_um (100 mm at most) whose normal is within 60 degrees of normal_bam (of
 * two point features any): its index, or ALE_NO_LANDMARK. 36 landmarks are compared. */
int32_t ale_landmarks_find(const ale_landmarks_t *landmarks, ale_point_t p, uint32_t normal_bam,
                           bool is_point, int32_t reach_um);

/* Adds a landmark, replacing the least seen of a full set. Constant work. */
void ale_landmarks_add(ale_landmarks_t *landmarks, const ale_landmark_t *landmark);

/* Removes those of a map. O(capacity). */
void ale_landmarks_give_up(ale_landmarks_t *landmarks, uint8_t map);

/* Of a map, removes those outside a box. O(capacity). */
void ale_landmarks_keep_within(ale_landmarks_t *landmarks, uint8_t map, const ale_box_t *box);

/* Kalman update by an independent observation with its variance, no lower than (3 mm)^2. */
void ale_landmark_observe(ale_landmark_t *landmark, ale_point_t p, uint32_t normal_bam, int64_t var_um2,
                          uint32_t scan);

#endif
