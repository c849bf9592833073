// Where the robot was, when all is known: map frame, by the number of the scan.
#ifndef ALE_GRAPH_POSE_OF_SCAN_H
#define ALE_GRAPH_POSE_OF_SCAN_H

#include <cstdint>
#include <functional>

extern "C" {
#include "base/pose.h"
}

namespace ale
{

using PoseOfScan = std::function<ale_pose_t(uint32_t scan)>;

} // namespace ale

#endif
