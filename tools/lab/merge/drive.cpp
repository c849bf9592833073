#include "lab/merge/drive.h"

#include <algorithm>

namespace merge
{

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

void number_frames(std::vector<Drive> *drives)
{
    uint32_t first = 0;
    for (Drive &drive : *drives) {
        uint32_t next = first;
        for (DriveScan &scan : drive.scans) {
            scan.frame += first;
            next = std::max(next, scan.frame + 1);
        }
        for (ale::Node &node : drive.nodes) {
            node.map_id += first;
        }
        first = next;
    }
}

} // namespace merge
