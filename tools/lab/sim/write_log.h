/* Drives the whole way at once and writes it as a CARMEN log (ROBOTLASER1) that ale-replay reads. */
#ifndef ALE_LAB_SIM_WRITE_LOG_H
#define ALE_LAB_SIM_WRITE_LOG_H

#include <cstdio>

#include "lab/sim/world/world_source.h"

namespace sim
{

/* Stamps are those of the beam straight ahead; truth (may be null) gets the robot's pose at each of them.
 * The source must have been made with `once`. Returns the number of scans. */
uint32_t write_log(WorldSource &source, std::FILE *log, std::FILE *truth);

} // namespace sim

#endif
