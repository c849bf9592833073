// The map drawn anew: walls and corners from the lines of all scans that are on record, where the corrected
// poses put them.
//
//   redraw_map(record, [&](const Sight &sight) { return pose_of(sight.scan); }, map);
//
// In the tracker's map a wall stays where the scan that saw it first has put it, and is moved as a whole;
// this asks every scan again. Deterministic; in the core's integers. O(lines * walls + cells of walls *
// looks).
#ifndef ALE_GRAPH_WALLS_MAP_REDRAW_H
#define ALE_GRAPH_WALLS_MAP_REDRAW_H

#include "graph/walls/map_record.h"
#include "graph/walls/pose_of_sight.h"

namespace ale
{

// Fills *out; walls that find no room are counted in it, the shortest are left out.
void redraw_map(const MapRecord &record, const PoseOfSight &pose_of, ale_map_t *out);

} // namespace ale

#endif
