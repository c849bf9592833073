// Corners of a rebuilt map: walls that scans saw meet are extended to a common corner.
#ifndef ALE_GRAPH_WALLS_WALL_CORNERS_H
#define ALE_GRAPH_WALLS_WALL_CORNERS_H

#include "graph/walls/observation_record.h"

namespace ale
{

// A map of any size.
struct WallMap {
    std::vector<ale_map_line_t> lines;
    std::vector<ale_map_corner_t> corners;
};

// Fills the corners of *map and moves the ends of its lines to them. A corner seen too seldom, or that no two
// lines of the map form, is left out; of more than ALE_MAP_MAX_CORNERS those that were seen last. May throw
// std::bad_alloc. O(corners seen * corners of the map + corners * lines^2).
void add_wall_corners(const ObservationRecord &record, const PoseOfScan &pose_of, WallMap *map);

} // namespace ale

#endif
