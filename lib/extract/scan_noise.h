/* The own noise of the scanner, measured in the scan itself. */
#ifndef ALE_EXTRACT_SCAN_NOISE_H
#define ALE_EXTRACT_SCAN_NOISE_H

#include "extract/workspace.h"

/* Sets e->noise from the second differences of 1/range (zero on a straight wall but for noise), by the
 * median in octaves of the range; where the scan has too few, the configured model serves. O(points). */
void ale_scan_noise_measure(ale_extractor_t *e, const ale_scan_t *scan);

/* Scales the shared part of e->noise, and of the fits of e->run, to what the blocks of beams of e->run show.
 * True when there is more of it than configured: then the runs were cut too short. O(points). */
bool ale_scan_noise_measure_shared(ale_extractor_t *e, const ale_scan_t *scan);

/* Refines the own noise by the residuals of e->run, where no shared error was found to hide it. Where it has
 * become less, runs that were whole are tried for a break again. O(runs). */
void ale_scan_noise_refine_own(ale_extractor_t *e);

#endif
