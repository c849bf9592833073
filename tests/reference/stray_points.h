// Twin of lib/extract/outlier.c: which points are no part of a surface.
#ifndef ALE_TESTS_REFERENCE_STRAY_POINTS_H
#define ALE_TESTS_REFERENCE_STRAY_POINTS_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// Changes of the range from point to point that exceed the noise.
int suspects(const ScanPoints &points, const NoiseOfScan &noise);

// Whether more changes of the range exceed the noise than surfaces make: then no point stands out.
bool is_unruly(const ScanPoints &points, const NoiseOfScan &noise);

// Whether point i stands out from its two neighbours, which agree with each other, and is no step.
bool is_spike(const ScanPoints &points, const NoiseOfScan &noise, double step, int i, Decisions &decisions);

ScanPoints without_spikes(const ScanPoints &points, const NoiseOfScan &noise, double step,
                          Decisions &decisions);

// Points of segments that have too few of them to be a surface are left out.
ScanPoints without_strays(const ScanPoints &points, const std::vector<Run> &segments);

} // namespace reference

#endif
