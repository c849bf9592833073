// Which lines of which scans show one wall.
//
// Longest first, every line joins the group that it lies in, or begins one. Then groups that are one wall
// are joined: those that continue or repeat each other within their errors, and those that lie side by side
// farther than poses err, when no scan has seen them apart: of two surfaces that face the same way the nearer
// hides the other, so that what stands twice in the map, and never in a scan, stands once. On a known wall
// the drive was laid: only what lies nearer to it than poses err is that wall.
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
    ale_observation_t view; // map frame; variances as one scan knows them
    // What the doubt of the pose adds to the variances.
    int64_t doubt_um2;
    int64_t doubt_urad2;
    uint32_t scans = 1; // that stand behind it; more than one: a wall of the map that the drive began in
};

struct WallGroup {
    ale_wall_t wall;             // as all its lines together have it
    std::vector<uint32_t> lines; // indices, ascending
};

// Lines by ascending scan. Groups by the length of their first line. O(lines * groups).
std::vector<WallGroup> group_lines(const std::vector<PlacedLine> &lines);

} // namespace ale

#endif
