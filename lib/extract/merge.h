/* Runs that are one line after all. */
#ifndef ALE_EXTRACT_MERGE_H
#define ALE_EXTRACT_MERGE_H

#include "extract/run_list.h"

/* Joins neighbouring runs, the least different first, while one line explains both as well as two do.
 * Whether there were any. */
bool ale_merge_runs(ale_run_list_t *r);

/* What two lines must explain better than one, of such a variance and shared error, to be two; mm^2 Q8.
 * on_one_surface: no jump lies between them, so that a shared error reaches over. */
int64_t ale_merge_gain_q8(const ale_scan_noise_t *noise, const ale_run_fit_t *one, bool on_one_surface);

/* What two lines a and b explain better than the one line through the points of both, over what they must,
 * each error the larger one of theirs; Q8: joined below 256. */
int64_t ale_merge_ratio_q8(const ale_scan_noise_t *noise, const ale_run_fit_t *one, const ale_run_fit_t *a,
                           const ale_run_fit_t *b, bool on_one_surface);

/* What a line may err by beyond its noise, where that grows with the square of the range (a scanner that
 * triangulates): from some metres on it hides steps as deep as cabinets and recesses, and one line is laid
 * through several surfaces. It is tilted alike in every scan, so its covariance must say so. Variances in
 * mm^2 Q8, each as of one of n independent points. */
typedef struct {
    int64_t var_q8; /* of a point along the normal: the own one, or what the residuals show if that is more */
    int64_t mean_q8;  /* of the mean, by a step that may be hidden */
    int64_t slope_q8; /* of the slope, by the same: at most 3/4 of m->along2_q8 */
} ale_merge_doubt_t;

/* Of a line through the points of m. Noise of any other kind hides no step: the own variance alone. Constant
 * time, for every spread of at most ALE_MAX_BEAMS points: beside m's own no product reaches 2^37. */
ale_merge_doubt_t ale_merge_doubt(const ale_scan_noise_t *noise, const ale_spread_t *m);

#endif
