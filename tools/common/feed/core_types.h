/* What came over LCM in metres and radians, in the core's integers: for everything that draws and writes
 * what the core makes. */
#ifndef ALE_COMMON_FEED_CORE_TYPES_H
#define ALE_COMMON_FEED_CORE_TYPES_H

#include <memory>

#include "ale/map_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "common/export/scan_cloud.h"
#include "common/feed/map_pieces.h"

extern "C" {
#include "track/pipeline.h"
}

namespace feed
{

ale_pose_t core_pose(float x, float y, float theta);

/* Map pose and motion of the robot at the stamp of a scan. */
ale::ScanPose core_scan_pose(const ale::pose_t &pose);

/* At most ALE_MAX_BEAMS beams, with a code for each. */
std::unique_ptr<ale_scan_t> core_scan(const ale::scan_t &scan);

/* Walls and corners beyond the core's capacity are left out. */
std::unique_ptr<ale_map_t> core_map(const ale::map_t &map, const MapPieces &pieces = {});

} // namespace feed

#endif
