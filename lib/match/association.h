/* Data association: which wall or landmark of the map an observation shows (the paper's "corresponding"
 * features).
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
    int32_t offset_um; /* largest error along the normal and of the angle, whatever the covariances */
    int32_t angle_urad;
    int32_t sigmas;     /* largest error in sigmas of observation, wall and pose together */
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

/* The landmark that a short segment or point feature shows from a viewpoint; error.offset_um is along the
 * landmark's normal, error.t_um across it. Constant work. */
ale_association_t ale_associate_landmark(const ale_local_map_t *map, const ale_observation_t *observation,
                                         const ale_viewpoint_t *viewpoint, int32_t reach_um);

/* Recomputes the errors of an association for another pose. Constant work. */
void ale_association_renew(const ale_local_map_t *map, const ale_observation_t *observation,
                           const ale_viewpoint_t *viewpoint, ale_association_t *association);

/* Work budget of one pass over the observations of a scan, in walls dismissed at first sight. It bounds the
 * work on a crowded map; two of a hundred recorded scans exceed it, and leave their last short segments
 * unassociated. */
enum {
    ALE_ASSOCIATION_WORK = 7680,
    ALE_WALL_WORK = 8,          /* a wall that is not dismissed at first sight */
    ALE_OBSERVATION_WORK = 128, /* in a fit: the search of its landmark and its rows */
    ALE_PLACEMENT_WORK = 16     /* an observation that is only laid on walls */
};

/* Work budget of a scan that is fitted twice, and what one beam of it has used before: deskewing, lines and
 * observations. Six whole passes are left for 682 beams. */
enum { ALE_SCAN_WORK = 73728, ALE_BEAM_WORK = 40 };

/* The wall, of those that the map is focused on, that an observation shows from a viewpoint whose pose has
 * the covariance `cov` (NULL: exact). The work is taken from *work; once that is spent, no wall is found. */
ale_association_t ale_associate(const ale_local_map_t *map, const ale_observation_t *observation,
                                const ale_viewpoint_t *viewpoint, const ale_matrix_t *cov,
                                const ale_gate_t *gate, int32_t *work);

#endif
