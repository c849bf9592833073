/* The noise as the runs show it: the error that neighbours share, and the own noise from the residuals. */
#ifndef ALE_EXTRACT_RUN_NOISE_H
#define ALE_EXTRACT_RUN_NOISE_H

#include <stdbool.h>

#include "extract/run_list.h"

/* Scales the shared part of the noise, and of the fits of the runs, to what their blocks of beams show. True
 * when there is more of it than configured: then the runs were cut too short. step_bam: from beam to beam.
 * O(points). */
bool ale_run_noise_measure_shared(ale_run_list_t *list, int32_t step_bam);

/* Refines the own noise by the residuals of the runs, where no shared error was found to hide it. Where it
 * has become less, runs that were whole are tried for a break again. O(runs). */
void ale_run_noise_refine_own(ale_run_list_t *list);

#endif
