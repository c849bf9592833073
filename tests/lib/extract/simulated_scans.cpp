#include "lib/extract/simulated_scans.h"

#include "lab/bench/simulate.hpp"

namespace scene
{

std::unique_ptr<ale_scan_t> simulated_scan(unsigned number, unsigned seed)
{
    const auto &kinds = bench::world_kinds();
    const auto &noises = bench::noise_kinds();
    bench::Random random(seed * std::uint64_t{1000003} + number);
    const bench::World world = bench::make_world(kinds[number % kinds.size()], random);
    return bench::simulate(world, noises[number / kinds.size() % noises.size()], random).scan;
}

} // namespace scene
