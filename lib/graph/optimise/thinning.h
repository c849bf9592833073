// Which keyframe a full graph can spare: the one whose surroundings are known best without it.
#ifndef ALE_GRAPH_OPTIMISE_THINNING_H
#define ALE_GRAPH_OPTIMISE_THINNING_H

#include <optional>
#include <vector>

#include "graph/optimise/se2.h"

namespace ale
{

// The pose with most others near it, in place and heading; of equals the first, which is the oldest. Only
// those that may go are chosen from, but all count. None: nobody may go. O(n^2); both of the same length.
std::optional<size_t> most_redundant(const std::vector<Pose> &poses, const std::vector<bool> &may_go);

} // namespace ale

#endif
