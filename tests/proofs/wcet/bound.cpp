#include "proofs/wcet/bound.hpp"

#include "proofs/wcet/parts.hpp"

namespace bench
{

namespace
{
constexpr int seeds = 8;
}

Bound bound_of_a_scan(CostCounter &counter)
{
    Parts any_scan(counter);
    Parts tracked(counter);
    Parts lost(counter);
    Parts one_of(counter);
    count_every_scan(any_scan);
    for (unsigned seed = 0; seed < seeds; seed++) {
        Random random(seed);
        for (const uint8_t kind : {ALE_OBSERVATION_LINE, ALE_OBSERVATION_SEGMENT, ALE_OBSERVATION_POINT}) {
            Crowd crowd(random, kind, seed % 2 == 1, seed % 4 < 2 ? ALE_MAP_MAX_LINES : ALE_MAX_OBSERVATIONS);
            count_tracked(tracked, random, crowd);
        }
    }
    for (unsigned seed = 0; seed < seeds; seed++) {
        Random random(seed);
        Crowd crowd(random, ALE_OBSERVATION_LINE, seed % 2 == 1,
                    seed % 4 < 2 ? ALE_MAP_MAX_LINES : ALE_MAX_OBSERVATIONS);
        count_lost(lost, one_of, random, crowd);
    }
    Random random(5);
    count_corners(tracked, random);
    count_tiles(one_of);
    return {any_scan.take(), tracked.take(), lost.take(), one_of.take()};
}

} // namespace bench
