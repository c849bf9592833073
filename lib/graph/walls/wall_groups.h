// Groups the lines of all scans by the wall that they show.
//
// Longest first, every line joins the group that it agrees with, or starts one. Then groups of one wall are
// merged: those that agree within their errors, and those side by side, farther apart than poses err, unless
// some scans have seen both at once as two surfaces. Of two surfaces that face the same way the nearer hides
// the other, so a wall that is double in the map, but single in every scan, is one wall. Next to a wall of a
// prior map, and between walls that no drive has both seen, only the first rule holds: what stands elsewhere
// since is another wall.
#ifndef ALE_GRAPH_WALLS_WALL_GROUPS_H
#define ALE_GRAPH_WALLS_WALL_GROUPS_H

#include <cstdint>
#include <vector>

extern "C" {
#include "map/wall.h"
#include "observe/observation.h"
}

namespace ale
{

// A line where the pose of its scan puts it.
struct PlacedLine {
    uint32_t scan;
    ale_observation_t line; // map frame; variances of the scan alone
    // What the error of the pose adds to the variances.
    int64_t pose_var_um2;
    int64_t pose_var_urad2;
    uint32_t scans = 1; // that support it; more than one: a wall of the prior map
    uint32_t drive = 0; // that saw it; larger is later
};

struct WallGroup {
    ale_wall_t wall;             // estimate from all its lines
    std::vector<uint32_t> lines; // indices, ascending
};

// Wall as a line of an observation: offset and variances at its anchor.
ale_observation_t as_observation(const ale_wall_t &wall);

// Lines by ascending scan and drive; groups by descending length of their first line. O(lines * groups +
// groups^3); may throw std::bad_alloc.
std::vector<WallGroup> group_lines(const std::vector<PlacedLine> &lines);

} // namespace ale

#endif
