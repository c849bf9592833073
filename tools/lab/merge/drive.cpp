#include "lab/merge/drive.h"

#include <algorithm>
#include <tuple>

namespace merge
{

namespace
{

template <class Renamed> void rename_frames(const Renamed &renamed, std::vector<Drive> *drives)
{
    for (Drive &drive : *drives) {
        for (DriveScan &scan : drive.scans) {
            scan.frame = renamed(scan.frame);
        }
        for (ale::Node &node : drive.nodes) {
            node.map_id = renamed(node.map_id);
        }
    }
}

} // namespace

uint32_t frames_of(const std::vector<Drive> &drives)
{
    uint32_t frames = 0;
    for (const Drive &drive : drives) {
        for (const DriveScan &scan : drive.scans) {
            frames = std::max(frames, scan.frame + 1);
        }
    }
    return frames;
}

void number_frames(uint32_t first, DriveGroup *group)
{
    rename_frames([first](uint32_t id) { return first + id; }, &group->drives);
    for (ale::FoundJoin &found : group->joins) {
        found.join.map_id += first;
        found.join.into_map_id += first;
    }
}

void make_first(uint32_t frame, std::vector<Drive> *drives)
{
    rename_frames([frame](uint32_t id) { return id == frame ? 0 : (id == 0 ? frame : id); }, drives);
}

bool is_earlier(const Drive &a, const Drive &b)
{
    return std::tie(a.date_s, a.checksum) < std::tie(b.date_s, b.checksum);
}

} // namespace merge
