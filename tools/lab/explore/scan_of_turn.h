/* What the simulated scanner measures, as a scan of the core: without a line between them. */
#ifndef ALE_LAB_EXPLORE_SCAN_OF_TURN_H
#define ALE_LAB_EXPLORE_SCAN_OF_TURN_H

#include "lab/sim/source.h"

extern "C" {
#include "base/scan.h"
}

namespace explore
{

/* A turn as the robot's driver hands it over: stamped at the passage of step 0. */
ale_scan_t scan_of_turn(const sim::Turn &turn, const sim::Scanner &scanner);

} // namespace explore

#endif
