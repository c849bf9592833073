/* Features of one scan: lines, corners and curves in the sensor's frame.
 *
 * A line is given in normal form, x cos(alpha) + y sin(alpha) = rho with rho >= 0. Beams are numbered as in
 * the scan; all ranges of beams include both ends. In a scan of a whole turn, whose first beam follows the
 * last one, a range may go on over that seam: then its first beam is above its last one. Plain values:
 * nothing is owned, a copy is a copy. */
#ifndef ALE_EXTRACT_FEATURES_H
#define ALE_EXTRACT_FEATURES_H

#include <stddef.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/pose.h"

/* No place of a scan's features lies farther from its sensor along an axis: a point at ALE_MAX_RANGE_UM, as
 * a line or an arc through it may be off it. */
#define ALE_MAX_PLACE_UM (1 << 29)

/* A line whose direction is not known to 8 degrees is none: (139626340 nrad)^2, in nrad^2. Neither
 * of the others of a covariance is larger than this, in its own unit. */
#define ALE_MOST_VAR_ALPHA_NRAD2 INT64_C(19495514821795600)

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
    ale_line_t line[ALE_MAX_LINES]; /* in the order of the beams; one over the seam is the last */
    ale_corner_t corner[ALE_MAX_CORNERS];
    ale_curve_t curve[ALE_MAX_CURVES];
    uint16_t refused[ALE_REFUSALS];
} ale_features_t;

/* The line over the seam of a whole turn, or NULL. */
static inline const ale_line_t *ale_features_line_over_seam(const ale_features_t *features)
{
    const ale_line_t *last = features->line_count > 0 ? &features->line[features->line_count - 1] : NULL;
    return last && last->first > last->last ? last : NULL;
}

#endif
