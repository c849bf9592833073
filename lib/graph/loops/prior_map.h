// The map that a drive begins in, as surfaces to match scans with.
//
//   PriorMap prior(map);
//   if (const auto match = prior.find(node.points, guess)) ... match->pose ...
#ifndef ALE_GRAPH_LOOPS_PRIOR_MAP_H
#define ALE_GRAPH_LOOPS_PRIOR_MAP_H

#include <optional>
#include <vector>

#include "graph/loops/pairwise_match.h"
#include "graph/loops/prior_views.h"
#include "graph/optimise/node.h"

extern "C" {
#include "map/line_map.h"
#include "map/tile_change.h"
#include "map/wall.h"
}

namespace ale
{

class PriorMap
{
  public:
    // Copies the walls: less than 1 MB, however long they are. May throw std::bad_alloc.
    explicit PriorMap(const ale_map_t &map);

    // Walls of tiles that come and go: one that is here already does not come again. O(walls that come or go
    // * walls); may throw std::bad_alloc.
    void change(const ale_tile_change_t &change);

    // The pose in the map from which these points, robot's frame, are seen near `guess`; see match_pair.
    // None: no match, or no walls near. O(walls) and one LikelihoodField; may throw std::bad_alloc.
    std::optional<PairwiseMatch> find(const std::vector<SurfacePoint> &seen, const Pose &guess) const;

    // What a robot would see of it; computed when first asked for after a change. May throw std::bad_alloc.
    const PriorViews &views();

  private:
    std::vector<SurfacePoint> points_around(const Pose &guess, double reach_m) const;

    std::vector<ale_wall_t> walls_;
    std::optional<PriorViews> views_;
};

} // namespace ale

#endif
