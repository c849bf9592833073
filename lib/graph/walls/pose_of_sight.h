// Where the robot was, as far as it is known now: map frame.
#ifndef ALE_GRAPH_WALLS_POSE_OF_SIGHT_H
#define ALE_GRAPH_WALLS_POSE_OF_SIGHT_H

#include <functional>

#include "graph/walls/map_record.h"

namespace ale
{

using PoseOfSight = std::function<ale_pose_t(const Sight &sight)>;

} // namespace ale

#endif
