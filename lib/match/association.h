/* Which wall of the map an observation shows: the paper's "corresponding" features, for lines.
 *
 * Among the near walls that face as the observation does, overlap it and lie no farther than the gate, the
 * one with the least squared distance in sigmas. Bounded by ALE_ASSOCIATION_WORK a pass over all
 * observations. */
#ifndef ALE_MATCH_ASSOCIATION_H
#define ALE_MATCH_ASSOCIATION_H

#include <stdint.h>

#include "map/local_map.h"
#include "motion/motion.h"
#include "observe/observation.h"

typedef struct {
    int32_t offset_um; /* farthest along the normal and by angle, whatever the covariances say */
    int32_t angle_urad;
    int32_t sigmas;     /* and in sigmas of view, wall and pose together */
    int32_t segment_um; /* reach of short segments and point features, 100 mm at most */
} ale_gate_t;

typedef struct {
    uint16_t wall;    /* ALE_NO_WALL: none */
    int32_t landmark; /* ALE_NO_LANDMARK: none; an observation shows a wall or a landmark */
    ale_wall_error_t error;
} ale_association_t;

/* Variance that the pose's covariance gives the offset of an observation at its centre, and its angle. */
int64_t ale_observation_offset_var(const ale_observation_t *observation, const ale_matrix_t *cov);
int64_t ale_observation_angle_var(const ale_matrix_t *cov);

/* The mark that a short segment or spot shows, seen from a pose; error.offset_um along the landmark's normal,
 * error.t_um across it. */
ale_association_t ale_associate_landmark(const ale_local_map_t *map, const ale_observation_t *observation,
                                         const ale_viewpoint_t *viewpoint, int32_t reach_um);

/* The errors of a match that is kept, with the robot at another pose. */
void ale_association_renew(const ale_local_map_t *map, const ale_observation_t *observation,
                           const ale_viewpoint_t *viewpoint, ale_association_t *association);

/* What one pass over the observations of a scan may cost, in first looks at a wall. It bounds the work on a
 * map that is crowded beyond reason: of recorded scans two in a hundred ask for more, and leave the last
 * short segments out.
 */
enum {
    ALE_ASSOCIATION_WORK = 7680,
    ALE_WALL_WORK = 8,          /* one that the first look does not dismiss */
    ALE_OBSERVATION_WORK = 128, /* in a fit: the search of its mark and its rows */
    ALE_PLACEMENT_WORK = 16     /* an observation that is only laid on walls */
};

/* What a scan that is fitted twice may cost. Its beams have taken their part before: straightening, lines and
 * observations of one cost as much as so many looks. Of 682 beams six whole passes are left, whatever they
 * show. */
enum { ALE_SCAN_WORK = 73728, ALE_BEAM_WORK = 40 };

/* The wall, of those that the map is focused on, that fits an observation seen from a pose with covariance
 * `cov` (NULL: known exactly). What is looked at is taken from *looks; with none left nothing more is found.
 */
ale_association_t ale_associate(const ale_local_map_t *map, const ale_observation_t *observation,
                                const ale_viewpoint_t *viewpoint, const ale_matrix_t *cov,
                                const ale_gate_t *gate, int32_t *work);

#endif
