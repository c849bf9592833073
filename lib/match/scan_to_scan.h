/* Scan-to-scan matching: a Hough vote over headings and displacements.
 *
 * Least squares needs a start from which each observation finds its own wall. After a metre and half a radian
 * on poor odometry there is none. Here every surface of the new scan is laid on every surface of the last
 * that then faces the same way; each pair allows the displacements along a line, and the scans lie on each
 * other where most lines cross. The paper (section IV) adopts one pair of features and checks the rest; all
 * pairs at once are its Hough transform. Bounded by the ALE_SCAN_MATCH_OBSERVATIONS longest observations of
 * each scan, and by headings, cells and votes as below; the longest observations vote first. */
#ifndef ALE_MATCH_SCAN_TO_SCAN_H
#define ALE_MATCH_SCAN_TO_SCAN_H

#include <stdbool.h>
#include <stdint.h>

#include "observe/observation.h"

enum {
    ALE_SCAN_MATCH_OBSERVATIONS = 20,
    ALE_SCAN_MATCH_HEADINGS = 15, /* odd: the guess and as many to either side */
    ALE_SCAN_MATCH_CELLS = 17,    /* a side, the guess in the middle, */
    ALE_SCAN_MATCH_COLUMNS = 20,  /* in rows of whole vectors */
    ALE_SCAN_MATCH_WORK = 640     /* of one heading, in votes, with those of pairs that face the same way;
                                       recorded scans ask for 300 as a rule */
};

typedef struct {
    const ale_observation_t *observation; /* robot's frame */
    uint32_t count;
} ale_observations_t;

/* A surface of the last scan. */
typedef struct {
    int32_t normal_x_q14; /* unit vector */
    int32_t normal_y_q14;
    int64_t offset_q14; /* of its centre along the normal, */
    int64_t along_q14;  /* and along the tangent, um */
    uint32_t normal_bam;
    int32_t length_mm;
    uint8_t kind; /* ale_observation_kind_t */
} ale_scan_match_surface_t;

/* Two surfaces that may be one, as they lie at the guess. */
typedef struct {
    uint32_t turned_bam; /* the new one's normal against the other's, and the limit for it: from here on */
    uint32_t width_bam;  /* less than this is within the limit, */
    int32_t along_um;    /* how far the centres may lie apart along the wall, */
    int32_t weight_mm;   /* and what it counts */
    uint16_t before;
} ale_scan_match_pair_t;

/* Working memory. */
typedef struct {
    uint16_t before[ALE_SCAN_MATCH_OBSERVATIONS];
    uint16_t now[ALE_SCAN_MATCH_OBSERVATIONS];
    uint32_t before_count;
    uint32_t now_count;
    ale_scan_match_surface_t surface[ALE_SCAN_MATCH_OBSERVATIONS]; /* of the observations before */
    ale_scan_match_pair_t pair[ALE_SCAN_MATCH_OBSERVATIONS * ALE_SCAN_MATCH_OBSERVATIONS];
    uint16_t pair_first[ALE_SCAN_MATCH_OBSERVATIONS + 1]; /* of each new observation */
    int32_t votes_mm[ALE_SCAN_MATCH_CELLS][ALE_SCAN_MATCH_COLUMNS];
    int32_t row_mm[ALE_SCAN_MATCH_CELLS]; /* sum of each row's votes */
    uint16_t voter[ALE_SCAN_MATCH_CELLS]
                  [ALE_SCAN_MATCH_COLUMNS]; /* the last observation that voted, and its heading */
    int32_t cell_um;
    int32_t half_um; /* of the grid's diagonal */
    int32_t work;    /* left for the heading at hand */
} ale_scan_match_t;

/* The pose of the new scan's robot as seen from the last one's; *guess on the way in, within the reaches, and
 * the best found on the way out. False when nothing fits, then *guess is untouched. */
bool ale_match_scans(ale_scan_match_t *memory, ale_observations_t before, ale_observations_t now,
                     int32_t reach_um, int32_t reach_urad, ale_pose_t *guess);

/* How far apart the places and the headings are that a vote with these reaches compares. */
int32_t ale_scan_match_cell_um(int64_t reach_um);
int32_t ale_scan_match_step_urad(int64_t reach_urad);

#endif
