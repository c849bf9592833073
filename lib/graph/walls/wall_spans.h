// Where along its line a wall stands, cell by cell of 5 cm.
//
// Each cell counts the scans whose lines cover it, and of the scans with beams those whose beams end there
// or, from either side, pass through. A cell that hardly any scan shows, or that more scans pass than hit, is
// free. Of two walls that face the same way side by side only one can have been seen: the one that more scans
// show. Scans of this drive decide before those of a prior map: what now stands before a known wall hides it.
//
// Of several drives the later decides: a cell that it shows free, or a wall, is that from then on, and of two
// walls side by side the one stands that was seen last.
#ifndef ALE_GRAPH_WALLS_WALL_SPANS_H
#define ALE_GRAPH_WALLS_WALL_SPANS_H

#include <vector>

#include "graph/walls/observation_record.h"
#include "graph/walls/wall_groups.h"

namespace ale
{

// A scan with all its beams, and the pose of its sensor in the map.
struct PlacedScan {
    const ale_seen_copy_t *beams;
    ale_pose_t sensor;
    uint32_t drive = 0; // larger is later
};

struct WallSpan {
    ale_wall_t wall; // from end to end of the span
    uint32_t scans;  // that show part of it
};

// Lines and scans by ascending drive. Spans in the order of the groups, at least ALE_WALL_LENGTH_UM long and
// shown by ALE_MAP_CONFIRMED scans. O(cells of all walls * scans in reach + groups * cells); may throw
// std::bad_alloc.
std::vector<WallSpan> spans_of(const std::vector<WallGroup> &groups, const std::vector<PlacedLine> &lines,
                               const std::vector<PlacedScan> &scans);

} // namespace ale

#endif
