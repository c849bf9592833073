/* Lines, corners and curves of one scan: the Adaptive Line Extraction algorithm (paper section III).
 *
 *   ale_extractor_t *e = ...;                      (static or from the heap: the caller's memory)
 *   ale_extractor_init(e, &config);
 *   ale_extract_scan(e, &scan, NULL, &features);
 *   for (i = 0; i < features.line_count; i++) ... features.line[i].rho_um ...
 *
 * Sensor frame. A line is given in normal form, x cos(alpha) + y sin(alpha) = rho with rho >= 0. */
#ifndef ALE_EXTRACT_EXTRACT_H
#define ALE_EXTRACT_EXTRACT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/noise.h"
#include "base/pose.h"
#include "base/scan.h"
#include "base/stage.h"

/* Why a line ends where it ends. */
typedef enum {
    ALE_END_EDGE = 0,     /* the wall really ends here: what lies beyond is farther away, or a corner */
    ALE_END_OCCLUDED = 1, /* something nearer hides the rest */
    ALE_END_LIMIT = 2     /* field of view, out of reach, or beams without a value */
} ale_end_kind_t;

typedef struct {
    uint16_t first; /* beams of the scan, inclusive */
    uint16_t last;
    uint16_t points;   /* valid beams the fit rests on */
    uint8_t first_end; /* ale_end_kind_t */
    uint8_t last_end;
    uint32_t alpha_bam;
    int32_t rho_um;
    ale_point_t start; /* ends on the line: at beam first, at beam last */
    ale_point_t end;
    int64_t var_alpha_nrad2; /* covariance of (alpha, rho), own noise and shared error together */
    int64_t cov_alpha_rho;   /* um * nrad */
    int64_t var_rho_um2;
    int64_t var_start_um2; /* variance of the ends along the line: where between two beams, and which */
    int64_t var_end_um2;
    int32_t rmse_um; /* of the raw points along the normal, n - 2 degrees of freedom */
} ale_line_t;

typedef enum { ALE_CORNER_CONVEX = 0, ALE_CORNER_CONCAVE = 1 } ale_corner_kind_t;

/* A real edge of two adjoining lines. Convex: it points towards the sensor. */
typedef struct {
    ale_point_t p;
    int64_t cov_um2[3];    /* xx, xy, yy */
    uint32_t angle_bam;    /* opening angle between the two walls, 0..half a turn */
    uint32_t bisector_bam; /* direction from the corner into the room, between the walls */
    uint16_t first_line;   /* indices in features.line */
    uint16_t second_line;
    uint8_t kind; /* ale_corner_kind_t */
} ale_corner_t;

/* A run of beams that lies on a curved surface: not a line. */
typedef struct {
    uint16_t first;
    uint16_t last;
    ale_point_t centre;
    int32_t radius_um; /* 0: not a circle */
} ale_curve_t;

/* Candidates refused, by the test that refused them. */
typedef enum {
    ALE_REFUSED_FEW_POINTS,
    ALE_REFUSED_SHORT,
    ALE_REFUSED_VAGUE, /* direction not known to 8 degrees */
    ALE_REFUSED_ROUGH, /* residual above what the noise allows */
    ALE_REFUSED_CURVED,
    ALE_REFUSED_CAPACITY, /* no room, or no time for so many */
    ALE_REFUSALS
} ale_refusal_t;

typedef struct {
    uint16_t line_count;
    uint16_t corner_count;
    uint16_t curve_count;
    uint16_t outliers;              /* beams set aside as stray points */
    ale_line_t line[ALE_MAX_LINES]; /* in the order of the beams */
    ale_corner_t corner[ALE_MAX_CORNERS];
    ale_curve_t curve[ALE_MAX_CURVES];
    uint16_t refused[ALE_REFUSALS];
} ale_features_t;

typedef struct {
    ale_noise_t noise;
    uint16_t min_points;   /* fewest beams of a line */
    int32_t min_length_um; /* shortest line */
    uint16_t smooth_span;  /* odd: beams of the lowess window */
    uint8_t robust_passes; /* upper bound of bisquare passes */
} ale_extract_config_t;

ale_extract_config_t ale_extract_default_config(void);

/* Working memory of the extractor. Its fields are in extract/workspace.h and are nobody else's business. */
typedef struct ale_extractor ale_extractor_t;

/* Bytes of an ale_extractor_t, for callers that provide the memory. */
uint32_t ale_extractor_size(void);

/* Prepares the extractor. The configuration is copied and checked: 0, or -1 when a value is out of range
 * (then nothing is changed). */
int ale_extractor_init(ale_extractor_t *extractor, const ale_extract_config_t *config);

/* The hook is told the ends of ALE_STAGE_SMOOTH and ALE_STAGE_EXTRACT. NULL: nobody. */
void ale_extractor_set_hook(ale_extractor_t *extractor, const ale_stage_hook_t *hook);

/* Extracts. scan->range_um and flag are read; bearing_bam, when not NULL, gives each beam's own bearing
 * (a straightened scan), else the scan's regular bearings are used. *out is written whole.
 * Work: bounded by scan->beams alone (see tests/lib/extract). Never fails. */
void ale_extract_scan(ale_extractor_t *extractor, const ale_scan_t *scan, const uint32_t *bearing_bam,
                      ale_features_t *out);

#endif
