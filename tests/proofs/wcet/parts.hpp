/* The parts of a scan's way, each counted with inputs that fill it. */
#ifndef BENCH_WCET_PARTS_HPP
#define BENCH_WCET_PARTS_HPP

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lab/bench/random.hpp"
#include "proofs/wcet/bound.hpp"
#include "proofs/wcet/crowd.hpp"

extern "C" {
#include "match/association.h"
#include "track/evidence/way_back.h"
}

namespace bench
{

/* Everything that is measured more than once counts as the most it took. */
class Parts
{
  public:
    explicit Parts(CostCounter &counter) : counter_(counter)
    {
    }

    template <typename Call> void measure(const std::string &name, int times, Call call)
    {
        const uint64_t each = counter_.of(call);
        for (BoundPart &part : parts_) {
            if (part.name == name) {
                part.each = std::max(part.each, each);
                return;
            }
        }
        parts_.push_back({name, times, each});
    }

    std::vector<BoundPart> take()
    {
        return std::move(parts_);
    }

  private:
    CostCounter &counter_;
    std::vector<BoundPart> parts_;
};

/* The wide gate of a first fit. */
constexpr ale_gate_t first_gate = {600000, 300000, 4, 100000};

/* As many scans from along the way as are kept. */
void way_back(ale_way_back_t &kept, const ale_seen_t &seen);

/* What every scan asks for. */
void count_every_scan(Parts &parts);

/* What tracking adds: in a crowd, and of corners, which ask for none. */
void count_tracked(Parts &parts, Random &random, Crowd &crowd);
void count_corners(Parts &parts, Random &random);

/* What is added where the robot is not where it should be, and of what else may be done then. */
void count_lost(Parts &lost, Parts &one_of, Random &random, const Crowd &crowd);
void count_tiles(Parts &parts);

} // namespace bench

#endif
