/* What fills the capacities of a map and of a scan's views: what the bound of a scan is counted with. */
#ifndef BENCH_WCET_CROWD_HPP
#define BENCH_WCET_CROWD_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include "lab/bench/random.hpp"

extern "C" {
#include "map/local_map.h"
#include "motion/motion.h"
#include "observe/observation.h"
}

namespace bench
{

/* All that a robot in the middle of a crowded map can see: a wall, or a mark, for every view, as many more
 * walls as there is room for, and marks wherever one is looked for. */
struct Crowd {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::vector<ale_observation_t> views;

    /* kind: of the views, ale_observation_kind_t; square: all face one of two ways; walls: of the map. */
    Crowd(Random &random, uint8_t kind, bool square, int walls);

  private:
    void add_wall(const ale_observation_t &view);
    void add_marks(const ale_observation_t &view);
};

uint32_t any_direction(Random &random);

/* Some centimetres off, moving, and not well known: three steps are needed. */
ale_motion_t any_motion(Random &random);

} // namespace bench

#endif
