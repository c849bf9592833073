/* Which wall of the map a view shows: the paper's "corresponding" features, for lines.
 *
 * Among the near walls that face as the view does, overlap it and lie no farther than the gate, the one
 * with the least squared distance in sigmas. Bounded by ALE_LOOKS a pass over all views. */
#ifndef ALE_MATCH_ASSOCIATION_H
#define ALE_MATCH_ASSOCIATION_H

#include <stdint.h>

#include "map/local_map.h"
#include "motion/motion.h"
#include "observe/observation.h"

typedef struct {
    int32_t offset_um; /* farthest along the normal and by angle, whatever the covariances say */
    int32_t angle_urad;
    int32_t sigmas;   /* and in sigmas of view, wall and pose together */
    int32_t piece_um; /* reach of pieces and spots, 100 mm at most */
} ale_gate_t;

typedef struct {
    uint16_t wall; /* ALE_NO_WALL: none */
    int32_t mark;  /* ALE_NO_MARK: none; a view shows a wall or a mark */
    ale_wall_error_t error;
} ale_match_t;

/* Variance that the pose's covariance gives the offset of a view at its centre, and its angle. */
int64_t ale_view_offset_var(const ale_view_t *view, const ale_matrix_t *cov);
int64_t ale_view_angle_var(const ale_matrix_t *cov);

/* The mark that a piece or spot shows, seen from a pose; error.offset_um along the mark's normal, error.t_um
 * across it. */
ale_match_t ale_match_mark(const ale_local_map_t *map, const ale_view_t *view, const ale_stand_t *stand,
                           int32_t reach_um);

/* The errors of a match that is kept, with the robot at another pose. */
void ale_match_renew(const ale_local_map_t *map, const ale_view_t *view, const ale_stand_t *stand,
                     ale_match_t *match);

/* What one pass over the views of a scan may cost, in first looks at a wall. It bounds the work on a map that
 * is crowded beyond reason: of recorded scans two in a hundred ask for more, and leave the last pieces out.
 */
enum {
    ALE_LOOKS = 7680,
    ALE_LOOKS_OF_A_WALL = 8,   /* one that the first look does not dismiss */
    ALE_LOOKS_OF_A_VIEW = 128, /* in a fit: the search of its mark and its rows */
    ALE_LOOKS_OF_A_MOVE = 16   /* a view that is only laid on walls */
};

/* What a scan that is fitted twice may cost. Its beams have taken their part before: straightening, lines and
 * views of one cost as much as so many looks. Of 682 beams six whole passes are left, whatever they show. */
enum { ALE_LOOKS_OF_A_SCAN = 73728, ALE_LOOKS_OF_A_BEAM = 40 };

/* The wall, of those that the map is focused on, that fits a view seen from a pose with covariance `cov`
 * (NULL: known exactly). What is looked at is taken from *looks; with none left nothing more is found. */
ale_match_t ale_match_view(const ale_local_map_t *map, const ale_view_t *view, const ale_stand_t *stand,
                           const ale_matrix_t *cov, const ale_gate_t *gate, int32_t *looks);

#endif
