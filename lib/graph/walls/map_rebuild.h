// Rebuilds the map from the lines of all recorded scans at their corrected poses.
//
//   rebuild_map(record, [&](const RecordedScan &scan) { return pose_of(scan.scan); }, map);
//
// The tracker's map moves a wall as a whole with the scan that saw it first; here every scan counts again.
// Deterministic, in the core's integers.
#ifndef ALE_GRAPH_WALLS_MAP_REBUILD_H
#define ALE_GRAPH_WALLS_MAP_REBUILD_H

#include "graph/walls/observation_record.h"
#include "graph/walls/wall_corners.h"

namespace ale
{

// The walls of the prior map are in the frame of the first map only.
enum class PriorWalls { counted, left_out };

// The map, whatever its size. May throw std::bad_alloc. O(lines * walls + cells of
// walls * scans with beams).
WallMap rebuild_walls(const ObservationRecord &record, const PoseOfScan &pose_of,
                      PriorWalls prior = PriorWalls::counted);

// Fills *out with ids from 0. Walls beyond ALE_MAP_MAX_LINES, the shortest, are counted in out->refused. May
// throw std::bad_alloc; *out then holds anything. O(lines * walls + cells of walls * scans with beams).
void rebuild_map(const ObservationRecord &record, const PoseOfScan &pose_of, ale_map_t *out,
                 PriorWalls prior = PriorWalls::counted);

} // namespace ale

#endif
