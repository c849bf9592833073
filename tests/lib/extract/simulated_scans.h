// Scans of the benchmark's worlds under its noises, for tests that hold stages against their twins.
#ifndef ALE_TESTS_LIB_EXTRACT_SIMULATED_SCANS_H
#define ALE_TESTS_LIB_EXTRACT_SIMULATED_SCANS_H

#include <memory>

extern "C" {
#include "base/scan.h"
}

namespace scene
{

// Scan number k goes through the ten kinds of world, every ten scans through the six noises.
std::unique_ptr<ale_scan_t> simulated_scan(unsigned number, unsigned seed);

} // namespace scene

#endif
