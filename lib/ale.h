/* libale: lines and corners from any 2D laser scan, in integers, without allocation and without I/O.
 *
 * One header for those who link the library alone: scans, the noise model, extraction.
 * tools/library/examples/lines.c is a whole program. The tracker behind it has a header of its own,
 * track/pipeline.h. */
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
