// Corners of a map that is drawn anew: where scans have seen two walls meet, the two walls meet.
#ifndef ALE_GRAPH_WALLS_MEETING_WALLS_H
#define ALE_GRAPH_WALLS_MEETING_WALLS_H

#include "graph/walls/map_record.h"
#include "graph/walls/pose_of_sight.h"

namespace ale
{

// Fills the corners of *map, and leads its lines to them. A corner that was seen too seldom, or that no two
// lines of the map make, is left out. O(corners seen * corners of the map + corners * lines^2).
void meet_corners(const MapRecord &record, const PoseOfSight &pose_of, ale_map_t *map);

} // namespace ale

#endif
