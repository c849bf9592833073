// Twin of ale_run_trim and take_points_beyond in lib/extract/runs.c: outer points that a run gives up or
// takes in.
#ifndef ALE_TESTS_REFERENCE_TRIMMED_RUN_H
#define ALE_TESTS_REFERENCE_TRIMMED_RUN_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// The run without those points at its ends, three at most each, that bring more squared residuals than noise
// would. It keeps least_points.
Run trimmed_run(const ScanPoints &points, const NoiseOfScan &noise, Run run, int least_points,
                Decisions &decisions);

// The run with the points beyond one of its ends where the surface ends, if they are too few for a run and no
// other run has them: all or half of them, what would not be given up again.
Run with_points_beyond(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                       const std::vector<Run> &others, Run run, bool at_first, Decisions &decisions);

} // namespace reference

#endif
