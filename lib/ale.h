/* libale: lines and corners from any 2D laser scan, in integers, without allocation and without I/O.
 *
 * One header for those who link the library alone, in C or C++: scans, the noise model, extraction.
 *
 *   static ale_scan_t scan;                        geometry, then ale_scan_set_range() for every beam
 *   static ale_features_t features;
 *   ale_extractor_t *extractor = malloc(ale_extractor_size());
 *   const ale_extract_config_t config = ale_extract_default_config();
 *   if (ale_extractor_init(extractor, &config) == 0) {
 *       ale_extract_scan(extractor, &scan, NULL, &features);
 *   }
 *
 * tools/library/examples/lines.c is a whole program. All memory is the caller's; its sizes: `ale-inspect
 * --sizes`, lib/extract/README.md. The one error of these headers is -1 from ale_extractor_init. Lengths are
 * micrometres, angles BAM (2^32 a turn, base/trig.h), times microseconds. No global state: different
 * extractors may run in different threads.
 *
 * The tracker behind it has a header of its own, track/pipeline.h. */
#ifndef ALE_ALE_H
#define ALE_ALE_H

#ifdef __cplusplus
extern "C" {
#endif

#include "base/fixed.h"
#include "base/limits.h"
#include "base/noise.h"
#include "base/pose.h"
#include "base/scan.h"
#include "base/stage.h"
#include "base/trig.h"
#include "extract/extract.h"

#ifdef __cplusplus
}
#endif

#endif
