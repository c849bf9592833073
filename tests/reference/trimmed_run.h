// Twin of ale_run_trim in lib/extract/runs.c: outer points that a run gives up.
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

} // namespace reference

#endif
