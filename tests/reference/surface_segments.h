// Twin of lib/extract/segment.c: between which points a surface ends.
#ifndef ALE_TESTS_REFERENCE_SURFACE_SEGMENTS_H
#define ALE_TESTS_REFERENCE_SURFACE_SEGMENTS_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// step: angle from beam to beam, radians.
bool is_jump(const ScanPoints &points, const NoiseOfScan &noise, double step, int after,
             Decisions &decisions);

std::vector<Run> surface_segments(const ScanPoints &points, const NoiseOfScan &noise, double step,
                                  Decisions &decisions);

// The segment that a point lies in.
Run segment_of(const std::vector<Run> &segments, int i);

// Whether two points lie in one segment.
bool on_one_surface(const std::vector<Run> &segments, int i, int j);

} // namespace reference

#endif
