// Building-direction constraint: most buildings are right-angled, so that the walls of a keyframe measure its
// heading modulo quarter turns and heading drift can be corrected.
//
// The constraint applies only if most walls agree with it. While driving it also needs drift larger than the
// spread of wall directions, and scan matches between neighbouring keyframes must not contradict it: in a
// bent building they do. Every function but matches_contradict may throw std::bad_alloc.
#ifndef ALE_GRAPH_WALLS_BUILDING_DIRECTION_H
#define ALE_GRAPH_WALLS_BUILDING_DIRECTION_H

#include <cstdint>
#include <optional>
#include <vector>

#include "graph/optimise/constraints.h"
#include "graph/optimise/node.h"

namespace ale
{

// Which scans count: the keyframes alone, or the scans after each too, whose noise then averages out.
enum class WallSource { keyframes, all_scans };

struct WallChoice {
    WallChoice(WallSource from = WallSource::keyframes, std::optional<uint32_t> of_map = std::nullopt)
        : source(from), map_id(of_map)
    {
    }
    WallSource source;
    std::optional<uint32_t> map_id; // only nodes of this map; none: all
};

// A heading prior for every node that sees enough wall along the building; none if the building is not
// right-angled. One pose for each node, map frame. O(walls).
BuildingConstraint building_constraint_from_walls(const std::vector<Node> &nodes,
                                                  const std::vector<Pose> &poses,
                                                  const WallChoice &choice = {});

// Whether eight priors in a row are off to the same side by more than wall directions spread. O(priors).
bool has_heading_drift(const BuildingConstraint &building, const std::vector<Pose> &poses);

// Whether scan matches show that the building is bent and nothing has drifted. The misfits are sums of
// PoseGraph::misfit over so many matches, of the graph solved with the constraint and without it. Without
// visible drift the bound is tighter. O(1).
bool matches_contradict(double misfit_with, double misfit_without, size_t matches, bool drifted);

} // namespace ale

#endif
