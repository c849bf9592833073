/* What a scan can cost the estimate task at most, argued from the capacities: every part of its way with
 * inputs that fill them, one after the other, though no scan asks for all of it at once. */
#ifndef BENCH_WCET_BOUND_HPP
#define BENCH_WCET_BOUND_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "bench/instruction_counter.hpp"

namespace bench
{

struct BoundPart {
    std::string name;
    int times;     /* at most, in one scan */
    uint64_t each; /* instructions */
};

/* The same parts and counts in every run. */
std::vector<BoundPart> bound_parts(InstructionCounter &counter);

} // namespace bench

#endif
