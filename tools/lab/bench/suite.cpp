#include "lab/bench/suite.hpp"

namespace bench
{

void for_each_case(const Noise &noise, int per_kind, std::uint64_t seed,
                   const std::function<void(const Case &)> &visit, int turn_beams)
{
    constexpr std::uint64_t worlds_a_seed = 1000000;
    int number = 0;
    for (int k = 0; k < per_kind; k++) {
        for (const std::string &kind : world_kinds()) {
            const std::uint64_t own_seed = seed * worlds_a_seed + static_cast<std::uint64_t>(number);
            Random world_random(own_seed);
            const World world = make_world(kind, world_random);
            Random noise_random(~own_seed);
            const Sensor sensor = turn_beams > 0 ? whole_turn(world, turn_beams, urg_reach) : Sensor{};
            const SimulatedScan simulated = simulate(world, noise, noise_random, sensor);
            const Truth truth = make_truth(world, noise, simulated);
            visit({number++, simulated, truth});
        }
    }
}

} // namespace bench
