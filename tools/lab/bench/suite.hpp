// Suites: simulated scans with their truth, the same for a seed on every machine.
#pragma once

#include <functional>

#include "lab/bench/truth.hpp"

namespace bench
{

struct Case {
    int number;
    const SimulatedScan &simulated;
    const Truth &truth;
};

// Goes through `per_kind` scans of every kind of world. The worlds are the same for all noises. turn_beams:
// of a scanner of a whole turn, whose turns see as far as a URG; 0: a URG.
void for_each_case(const Noise &noise, int per_kind, std::uint64_t seed,
                   const std::function<void(const Case &)> &visit, int turn_beams = 0);

} // namespace bench
