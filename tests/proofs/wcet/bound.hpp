/* What a scan can cost the estimate task at most, argued from the capacities: every part of its way with
 * inputs that fill them, one after the other, though no scan asks for all of it at once. */
#ifndef BENCH_WCET_BOUND_HPP
#define BENCH_WCET_BOUND_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "proofs/wcet/cost_counter.hpp"

namespace bench
{

struct BoundPart {
    std::string name;
    int times;     /* at most, in one scan */
    uint64_t each; /* instructions */
};

/* What every scan asks for, what tracking adds, what is added where the robot is not where it should be, and
 * of what else may be done then the one that is: a scan that is compared with all poses within reach is not
 * searched for in an older map, and one that joins two maps is not searched for at all; after a scan that
 * does any of these the map takes no piece of a tile. */
struct Bound {
    std::vector<BoundPart> any_scan;
    std::vector<BoundPart> tracked;
    std::vector<BoundPart> lost;
    std::vector<BoundPart> one_of;
};

/* The same parts and counts in every run. */
Bound bound_of_a_scan(CostCounter &counter);

} // namespace bench

#endif
