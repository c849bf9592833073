// Where along its line a wall stands.
//
// Along the wall, cell by cell: scans whose lines cover it, looks whose beams end there, and looks that see
// through it. What hardly a scan has shown, and what more looks see through than not, is no wall. Where two
// walls that face the same way lie side by side only one can have been seen: the one that more scans show.
// Scans of the drive count before those of a map that it began in: what now stands before a known wall hides
// it.
#ifndef ALE_GRAPH_WALLS_WALL_SPANS_H
#define ALE_GRAPH_WALLS_WALL_SPANS_H

#include <vector>

#include "graph/walls/map_record.h"
#include "graph/walls/wall_groups.h"

namespace ale
{

// A look, and where its laser was.
struct PlacedLook {
    const ale_seen_copy_t *seen;
    ale_pose_t sensor;
};

struct WallSpan {
    ale_wall_t wall; // from end to end of the span
    uint32_t seen;   // scans that show part of it
};

// In the order of the groups. O(cells of all walls * looks in reach + groups * cells).
std::vector<WallSpan> spans_of(const std::vector<WallGroup> &groups, const std::vector<PlacedLine> &lines,
                               const std::vector<PlacedLook> &looks);

} // namespace ale

#endif
