/* Registration of a scan to the map by least squares, together with the prediction; paper, section IV.
 *
 * An iterated Kalman update in information form corrects the predicted state (pose and velocity with
 * covariance). Each associated wall gives two independent rows: the offset at the observation's centre, and
 * what its angle says beyond that, weighted by the covariances of observation and wall; large errors lose
 * weight (Huber). The rows depend on the velocity too, by the time at which the wall was swept: the motion
 * within the scan is estimated along with the pose. What the scene does not determine keeps the prediction
 * and its variance. At most ALE_REGISTER_ITERATIONS passes, each bounded by ALE_ASSOCIATION_WORK. */
#ifndef ALE_MATCH_SCAN_TO_MAP_H
#define ALE_MATCH_SCAN_TO_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "map/local_map.h"
#include "match/association.h"
#include "match/information.h"
#include "motion/motion.h"
#include "observe/observation.h"
#include "observe/short_segment.h"

enum { ALE_REGISTER_ITERATIONS = 3 };

typedef struct {
    ale_local_map_t *map; /* near list prepared (ale_local_map_approach); a fit focuses it */
    const ale_observation_t *observation;
    uint32_t observation_count; /* ALE_MAX_OBSERVATIONS at most */
    const int32_t *velocity;    /* that the scan was deskewed with; NULL: the predicted one */
} ale_scene_t;

typedef struct {
    ale_motion_t motion;           /* corrected; its covariance once it is weighed */
    int64_t velocity_change[3];    /* against the velocity that the scan was deskewed with */
    ale_matrix_t prior;            /* the prediction's information, Q54 */
    ale_information_t information; /* of the scan alone */
    ale_factors_t factors;         /* of both together, at the last step */
    ale_association_t association[ALE_MAX_OBSERVATIONS];
    uint16_t matched;          /* lines that found a wall */
    uint16_t matched_segments; /* short segments and point features that found a wall or a landmark */
    int64_t matched_um;        /* their length, and that of all observations */
    int64_t shown_um;
    int32_t work; /* of its passes over the observations: see association.h */
    uint8_t iterations;
} ale_fit_t;

/* An observation's errors against its wall with the change of velocity taken in; derivatives Q14. */
typedef struct {
    int64_t offset_row_q14[ALE_STATES];
    int64_t angle_row_q14[ALE_STATES];
} ale_observation_rows_t;

void ale_observation_rows(const ale_observation_t *observation, uint32_t pose_theta_bam,
                          uint32_t wall_normal_bam, ale_observation_rows_t *out);

/* Registers a scan: the three parts below in one call. */
void ale_register_scan(const ale_motion_t *predicted, const ale_scene_t *scene, const ale_gate_t *gate,
                       ale_fit_t *out);

/* Its three parts. pose: out->motion without its covariance, which is all that is asked of one of many
 * trials. associate: the associations there; the map must still be focused by that fit. weigh: errors with
 * the velocity found, information and covariance. */
void ale_register_pose(const ale_motion_t *predicted, const ale_scene_t *scene, const ale_gate_t *gate,
                       ale_fit_t *out);
void ale_register_associate(const ale_scene_t *scene, ale_fit_t *fit);
void ale_register_weigh(const ale_scene_t *scene, ale_fit_t *fit);

/* A second fit of the same scan. */
typedef struct {
    const ale_motion_t *predicted;
    bool is_new_prior;      /* predicted is not that of the first fit */
    ale_pose_t start;       /* where the iterations begin */
    const ale_gate_t *gate; /* of the first iteration */
    int32_t most_work; /* of both fits together; where two more passes would exceed it, one step is made */
    int64_t least_more_um; /* that it must explain more than the first; 0: it is kept of two equals */
} ale_second_fit_t;

/* Fits once more, and keeps that fit if it explains so much more. True: it is kept. fit: associated and not
 * yet weighed, on return again. other: working memory. */
bool ale_register_again(const ale_scene_t *scene, const ale_second_fit_t *second, ale_fit_t *other,
                        ale_fit_t *fit);

/* The fit of a rejected scan: the prediction stands, nothing is associated. O(observations). */
void ale_register_reject(const ale_motion_t *predicted, const ale_scene_t *scene, ale_fit_t *fit);

#endif
