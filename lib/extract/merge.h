/* Runs that are one line after all. */
#ifndef ALE_EXTRACT_MERGE_H
#define ALE_EXTRACT_MERGE_H

#include "extract/workspace.h"

/* Joins neighbouring runs, the least different first, while one line explains both as well as two do. */
void ale_merge_runs(ale_extractor_t *e);

/* What two lines explain better than one, over what noise alone would give, Q8: joined below 256. */
int64_t ale_merge_ratio_q8(const ale_extractor_t *e, ale_run_t a, ale_run_t b);

#endif
