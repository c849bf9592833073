/* Beam geometries that the formats share, and what their range values mean. Internal to drivers/log. */
#ifndef ALE_LOG_GEOMETRY_H
#define ALE_LOG_GEOMETRY_H

#include "base/scan.h"

/* One step of the URG-04LX: 360/1024 degrees, exactly. */
#define ALE_URG_STEP_BAM (1 << 22)

/* A URG-04LX scan of which beam 0 is the sensor's step first_step (step 384 looks ahead), swept. */
void ale_geometry_urg(ale_scan_t *scan, int32_t first_step, uint16_t beams);

/* A laser of which only the number of beams is known (1..ALE_MAX_BEAMS): CARMEN's conventions. */
void ale_geometry_by_count(ale_scan_t *scan, uint16_t beams);

/* A step that was printed with six digits or more: the exact part of a turn that was meant, if one is within
 * 10^-6 rad (0.017453 is a degree, 0.006135923 is 1/1024 turn), else the step as it is. */
int32_t ale_geometry_whole_step(int32_t step_bam);

/* Sets one beam of a laser that tells "no return" by one of the usual values (31.9, 32.759 to 32.767,
 * range_max). */
void ale_geometry_set_range(ale_scan_t *scan, uint16_t beam, int32_t range_um);

#endif
