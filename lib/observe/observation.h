/* A wall as one scan shows it, in the robot's frame: the input of association and registration.
 *
 *            start ------- centre ------------- end      tangent: start to end, counter-clockwise
 *                            | normal                     as seen from the sensor
 *                            v
 *                          sensor
 *
 * The covariance (alpha, rho) of the extracted line is turned into two independent errors: of the offset
 * along the normal at the line's centre (the centre of weight of its points), and of its angle. */
#ifndef ALE_OBSERVE_OBSERVATION_H
#define ALE_OBSERVE_OBSERVATION_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/extract.h"

/* Observations of one scan, at most: nine recorded scans of 682 beams in ten have no more. Of more an even
 * choice is made, since the time of a fit is proportional to their number. */
enum { ALE_MAX_OBSERVATIONS = 44 };

/* Whether the i-th of n is in the even choice of at most `most` of them. */
static inline bool ale_is_chosen(uint32_t i, uint32_t n, uint32_t most)
{
    return n <= most || (i + 1) * most / n != i * most / n;
}

/* Shorter lines begin no wall in the map, but a landmark, as short segments do. */
enum { ALE_WALL_LENGTH_UM = 250000 };

typedef enum {
    ALE_OBSERVATION_LINE = 0,    /* an extracted line */
    ALE_OBSERVATION_SEGMENT = 1, /* a few beams of a surface that made no line */
    ALE_OBSERVATION_POINT = 2    /* a small object that stands alone, such as the leg of a table */
} ale_observation_kind_t;

typedef struct {
    ale_point_t centre;
    uint32_t normal_bam; /* towards the sensor */
    int32_t start_um;    /* along the tangent, from the centre: start < 0 < end, as a rule */
    int32_t end_um;
    int64_t var_offset_um2;
    int64_t var_angle_urad2;
    int32_t start_time_us; /* when its ends were measured, relative to the scan's stamp */
    int32_t end_time_us;
    uint16_t first_beam; /* of those that show it; beyond last_beam: over the seam of a whole turn */
    uint16_t last_beam;
    uint8_t start_end; /* ale_end_kind_t of either end */
    uint8_t end_end;
    uint8_t kind; /* ale_observation_kind_t */
} ale_observation_t;

/* Beams of its scan from the first to the last that shows it. */
static inline int32_t ale_observation_beams(const ale_observation_t *observation, const ale_scan_t *scan)
{
    const int32_t ahead = observation->last_beam - observation->first_beam;
    return (ahead < 0 ? ahead + scan->beams : ahead) + 1;
}

static inline int64_t ale_observation_length_um(const ale_observation_t *observation)
{
    return (int64_t)observation->end_um - observation->start_um;
}

/* Length of all of them together. */
int64_t ale_observations_length_um(const ale_observation_t observation[], uint32_t count);

/* Observations of the lines of a scan, in the frame of the sensor's pose (the robot's). systematic_um: one
 * sigma of errors that are the same in every scan (surface, range bias) and that averaging does not reduce.
 * Returns their number, ALE_MAX_OBSERVATIONS at most. O(lines). */
uint32_t ale_observe_lines(const ale_features_t *features, const ale_scan_t *scan, ale_pose_t sensor,
                           int32_t systematic_um, ale_observation_t out[ALE_MAX_OBSERVATIONS]);

/* A pose with the cosine and sine of its heading, for placing many observations. */
typedef struct {
    ale_pose_t pose;
    ale_direction_t turn;
} ale_viewpoint_t;

static inline ale_viewpoint_t ale_viewpoint(ale_pose_t pose)
{
    return (ale_viewpoint_t){pose, ale_direction(pose.theta_bam)};
}

static inline ale_point_t ale_minus(ale_point_t a, ale_point_t b)
{
    return (ale_point_t){a.x_um - b.x_um, a.y_um - b.y_um};
}

static inline ale_point_t ale_plus(ale_point_t a, ale_point_t b)
{
    return (ale_point_t){a.x_um + b.x_um, a.y_um + b.y_um};
}

/* A point and an observation of the viewpoint's frame in the frame that its pose is given in. */
static inline ale_point_t ale_point_from(ale_point_t p, const ale_viewpoint_t *viewpoint)
{
    return ale_plus(ale_turn(p, viewpoint->turn), (ale_point_t){viewpoint->pose.x_um, viewpoint->pose.y_um});
}
ale_observation_t ale_observation_from(const ale_observation_t *observation,
                                       const ale_viewpoint_t *viewpoint);

/* The tangent that belongs to a normal (a quarter turn clockwise), as a direction. */
static inline uint32_t ale_tangent_bam(uint32_t normal_bam)
{
    return normal_bam - 0x40000000u;
}

/* A vector of a length (um) in a direction. */
ale_point_t ale_polar(int64_t length_um, uint32_t direction_bam);

/* Component of a vector along a direction, um. */
int64_t ale_along(ale_point_t v, uint32_t direction_bam);

#endif
