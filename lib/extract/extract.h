/* Lines, corners and curves of one scan: the Adaptive Line Extraction algorithm (paper section III).
 *
 *   ale_extractor_t *e = malloc(ale_extractor_size());      (or static: the memory is the caller's)
 *   const ale_extract_config_t config = ale_extract_default_config();
 *   if (ale_extractor_init(e, &config) == 0) {
 *       ale_extract_scan(e, &scan, NULL, &features);
 *       for (i = 0; i < features.line_count; i++) ... features.line[i].rho_um ...
 *   }
 *
 * No function allocates, reads a clock, or keeps a pointer but the hook's. One extractor serves one thread at
 * a time; extractors share nothing. */
#ifndef ALE_EXTRACT_EXTRACT_H
#define ALE_EXTRACT_EXTRACT_H

#include <stdint.h>

#include "base/noise.h"
#include "base/scan.h"
#include "base/stage.h"
#include "extract/config.h"
#include "extract/features.h"

/* The settings that serve all scanners tried: noise of the URG-04LX, lines of 9 beams and 140 mm, not
 * smoothed. Constant time, no error. */
ale_extract_config_t ale_extract_default_config(void);

/* Working memory of the extractor: ale_extractor_size() bytes, aligned as malloc aligns. What is in it is
 * nobody else's business. */
typedef struct ale_extractor ale_extractor_t;

/* Bytes of an ale_extractor_t, for callers that provide the memory. Constant time, no error. */
uint32_t ale_extractor_size(void);

/* Prepares the extractor, whatever its memory held before; no hook is set. The configuration is copied.
 * 0; -1: a value of the configuration is out of its range, and the extractor is as it was. O(ALE_MAX_BEAMS).
 */
int ale_extractor_init(ale_extractor_t *extractor, const ale_extract_config_t *config);

/* The hook is told the ends of ALE_STAGE_SMOOTH and ALE_STAGE_EXTRACT, from within ale_extract_scan. It is
 * copied; its user must live as long as it is set. NULL: nobody is told. Constant time, no error. */
void ale_extractor_set_hook(ale_extractor_t *extractor, const ale_stage_hook_t *hook);

/* Extracts the features of a scan, in its sensor's frame.
 *
 * Of the scan its geometry, beams (at most ALE_MAX_BEAMS), range_um and flag are read. Beams count that are
 * ALE_BEAM_VALID and between 16.384 mm and ALE_MAX_RANGE_UM. bearing_bam: each beam's own bearing, in the
 * order of the scan (a scan straightened along the robot's motion), or NULL: those of the scan's geometry.
 * *out is written whole; what does not fit its capacities is counted in out->refused.
 *
 * No error: a scan without beams has no features. Nothing of a scan is kept but the directions of its beams,
 * so that the same scan always gives the same bytes. Work is bounded by the number of beams alone: twice the
 * mean of rooms, and some (lib/extract/README.md). Paper: III, IV and the listing. */
void ale_extract_scan(ale_extractor_t *extractor, const ale_scan_t *scan, const uint32_t *bearing_bam,
                      ale_features_t *out);

/* The configured noise model with the beams' own noise as it was measured in the scan extracted last (none
 * before the first scan). Constant time, no error. */
ale_noise_t ale_extractor_noise(const ale_extractor_t *extractor);

/* From the next scan on. 0, or -1 where the model is out of range, and nothing has changed. */
int ale_extractor_set_noise(ale_extractor_t *extractor, const ale_noise_t *noise);

#endif
