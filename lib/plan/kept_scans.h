/* The scans that a grid was drawn from, kept thinly, so that it can be drawn again when loops have moved the
 * past.
 *
 *   ale_kept_scans_clear(kept);
 *   ale_kept_scans_offer(kept, number, &scan, bearing_bam, robot);     every scan that the grid gets
 *   if (ale_kept_scans_correct(kept, &correction))                     loops have moved some by half a cell
 *       ale_kept_scans_draw(kept, sensor, radius_um, grid, &spare);
 *
 * One is kept for every 10 cm driven or eighth of a radian turned. When there is no room every other one is
 * dropped, and from then on those kept lie twice as far apart. One owner thread; no allocation, every loop
 * bounded by ALE_KEPT_SCANS. No function fails or keeps a pointer; the memory is the caller's. */
#ifndef ALE_PLAN_KEPT_SCANS_H
#define ALE_PLAN_KEPT_SCANS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/pose.h"
#include "base/scan.h"
#include "plan/grid.h"
#include "track/correction.h"

enum { ALE_KEPT_SCANS = 2048 };

typedef struct {
    uint32_t number;  /* of the scan */
    ale_pose_t robot; /* map frame, as corrected so far */
    ale_pose_t drawn; /* where the grid has it */
    int32_t range_max_um;
    uint16_t beams;
    uint16_t range_4mm[ALE_MAX_BEAMS];       /* 0: says nothing; UINT16_MAX: no return */
    uint16_t bearing_bam_q16[ALE_MAX_BEAMS]; /* upper half of the bearing in the sensor's frame */
} ale_kept_scan_t;

typedef struct {
    uint32_t count;
    uint32_t thinned; /* so many times */
    ale_kept_scan_t scan[ALE_KEPT_SCANS];
} ale_kept_scans_t;

/* A scan for drawing, and the bearings of its beams. */
typedef struct {
    ale_scan_t scan;
    uint32_t bearing_bam[ALE_MAX_BEAMS];
} ale_straight_scan_t;

/* None kept. Constant time. */
void ale_kept_scans_clear(ale_kept_scans_t *kept);

/* A scan as ale_grid_add_scan takes it, seen while the robot was at `robot` (map frame); number: that of its
 * estimate, ascending. Kept when the robot has gone on since the last one kept. O(beams), O(ALE_KEPT_SCANS *
 * beams) when it has to make room. */
void ale_kept_scans_offer(ale_kept_scans_t *kept, uint32_t number, const ale_scan_t *scan,
                          const uint32_t bearing_bam[], ale_pose_t robot);

/* Moves them. True: one of them now lies more than half a cell, or half a cell in five metres, from
 * where it was drawn. O(ALE_KEPT_SCANS). */
bool ale_kept_scans_correct(ale_kept_scans_t *kept, const ale_correction_t *correction);

/* Draws them into a cleared grid; sensor: mounting; radius_um: of the disc that was free where the robot
 * drove. O(ALE_KEPT_SCANS * beams * reach / cell): part of a second. */
void ale_kept_scans_draw(ale_kept_scans_t *kept, ale_pose_t sensor, int32_t radius_um, ale_grid_t *grid,
                         ale_straight_scan_t *spare);

#endif
