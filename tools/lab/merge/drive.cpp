#include "lab/merge/drive.h"

#include <algorithm>
#include <tuple>

namespace merge
{

namespace
{

uint32_t frames_of_one(const Drive &drive)
{
    uint32_t frames = 0;
    for (const DriveScan &scan : drive.scans) {
        frames = std::max(frames, scan.frame + 1);
    }
    return frames;
}

} // namespace

uint32_t frames_of(const std::vector<Drive> &drives)
{
    uint32_t frames = 0;
    for (const Drive &drive : drives) {
        frames = std::max(frames, frames_of_one(drive));
    }
    return frames;
}

void number_frames(std::vector<Drive> *drives, size_t placed)
{
    uint32_t first = 0;
    for (size_t k = 0; k < placed; k++) {
        first = std::max(first, frames_of_one((*drives)[k]));
    }
    for (size_t k = placed; k < drives->size(); k++) {
        Drive &drive = (*drives)[k];
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

void make_first(uint32_t frame, std::vector<Drive> *drives)
{
    const auto exchanged = [frame](uint32_t id) { return id == frame ? 0 : (id == 0 ? frame : id); };
    for (Drive &drive : *drives) {
        for (DriveScan &scan : drive.scans) {
            scan.frame = exchanged(scan.frame);
        }
        for (ale::Node &node : drive.nodes) {
            node.map_id = exchanged(node.map_id);
        }
    }
}

bool is_earlier(const Drive &a, const Drive &b)
{
    return std::tie(a.date_s, a.checksum) < std::tie(b.date_s, b.checksum);
}

} // namespace merge
