// A map that was there before the drive, as scans see it: the surfaces of its walls.
//
//   KnownMap known(map);
//   if (const auto match = known.find(node.points, guess)) ... match->pose ...
#ifndef ALE_GRAPH_LOOPS_KNOWN_MAP_H
#define ALE_GRAPH_LOOPS_KNOWN_MAP_H

#include <optional>
#include <vector>

#include "graph/loops/tight_match.h"
#include "graph/optimise/node.h"

extern "C" {
#include "map/wall.h"
#include "track/pipeline.h"
}

namespace ale
{

class KnownMap
{
  public:
    explicit KnownMap(const ale_map_t &map);

    // Where points that are seen from about `guess` lie in the map, see match_to.
    std::optional<TightMatch> find(const std::vector<SurfacePoint> &seen, const Pose &guess) const;

  private:
    std::vector<SurfacePoint> around(const Pose &guess, double reach_m) const;

    std::vector<ale_wall_t> walls_; // and not their points: they may be as long as they like
};

} // namespace ale

#endif
