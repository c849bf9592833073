/* Drives the whole way at once and writes what passes on the line of a scanner of a whole turn as a .scip
 * recording that ale-replay reads. */
#ifndef ALE_LAB_SIM_WRITE_RECORDING_H
#define ALE_LAB_SIM_WRITE_RECORDING_H

#include <cstdint>
#include <cstdio>
#include <string>

#include "lab/sim/device/sensors.h"
#include "lab/sim/world/world_source.h"

namespace sim
{

/* truth (may be null) gets the robot's pose every 50 ms. The source must have been made with `once`. Returns
 * the number of turns; throws std::runtime_error when the file cannot be written. */
uint32_t write_recording(WorldSource &source, const Sensor &sensor, const std::string &path,
                         std::FILE *truth);

} // namespace sim

#endif
