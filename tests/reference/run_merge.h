// Twin of lib/extract/merge.c: runs that one line explains as well as two do.
#ifndef ALE_TESTS_REFERENCE_RUN_MERGE_H
#define ALE_TESTS_REFERENCE_RUN_MERGE_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// What two lines explain better than one, over what noise alone would let them: below 1 they are one.
double merge_ratio(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                   Run a, Run b);

// Joins neighbours, the most alike first, as long as any two are one.
std::vector<Run> merged_runs(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, Decisions &decisions);

} // namespace reference

#endif
