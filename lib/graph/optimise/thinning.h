// Which keyframe a full graph can spare: the one whose surroundings are known best without it.
#ifndef ALE_GRAPH_OPTIMISE_THINNING_H
#define ALE_GRAPH_OPTIMISE_THINNING_H

#include <optional>
#include <vector>

#include "graph/optimise/se2.h"

namespace ale
{

// The removable pose with most others near it, in place and heading; of equals the oldest. All poses count as
// neighbours. None: no pose is removable. Both lists have the same length. O(n^2); may throw std::bad_alloc.
std::optional<size_t> most_redundant(const std::vector<Pose> &poses, const std::vector<bool> &removable);

} // namespace ale

#endif
