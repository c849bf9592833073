/* Runs that are one line after all. */
#ifndef ALE_EXTRACT_MERGE_H
#define ALE_EXTRACT_MERGE_H

#include "extract/run_list.h"

/* Joins neighbouring runs, the least different first, while one line explains both as well as two do.
 * Whether there were any. */
bool ale_merge_runs(ale_run_list_t *r);

/* What two lines a and b explain better than the one line through the points of both, over what noise alone
 * would give, Q8: joined below 256. on_one_surface: no jump lies between them, so that a shared error reaches
 * over. */
int64_t ale_merge_ratio_q8(const ale_scan_noise_t *noise, const ale_run_fit_t *one, const ale_run_fit_t *a,
                           const ale_run_fit_t *b, bool on_one_surface);

#endif
