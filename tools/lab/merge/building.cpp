#include "lab/merge/building.h"

#include <algorithm>

#include "graph/walls/map_rebuild.h"

namespace merge
{

namespace
{

constexpr uint32_t earlier_epoch = 1; /* any that is some */

} // namespace

uint32_t largest_frame(const std::vector<Drive> &drives)
{
    std::vector<size_t> scans(frames_of(drives));
    for (const Drive &drive : drives) {
        for (const DriveScan &scan : drive.scans) {
            scans[scan.frame]++;
        }
    }
    return static_cast<uint32_t>(std::max_element(scans.begin(), scans.end()) - scans.begin());
}

Building::Building(std::vector<Drive> *drives, uint32_t frame, const ale_map_t *earlier)
{
    if (earlier) {
        record_.set_prior_map(earlier_epoch, *earlier);
    }
    for (Drive &drive : *drives) {
        first_scan_.push_back(poses_.size());
        record_.append(std::move(drive.record), static_cast<uint32_t>(poses_.size()));
        for (const DriveScan &scan : drive.scans) {
            const bool is_here = scan.frame == frame;
            poses_.push_back(is_here ? std::optional(ale::to_core(scan.pose)) : std::nullopt);
        }
    }
}

std::optional<ale_pose_t> Building::pose_of(const ale::RecordedScan &scan) const
{
    return poses_[scan.scan];
}

void Building::draw(ale_map_t *out) const
{
    ale::rebuild_map(
        record_, [this](const ale::RecordedScan &scan) { return pose_of(scan); }, out);
}

ale::WallMap Building::draw_all() const
{
    return ale::rebuild_walls(record_, [this](const ale::RecordedScan &scan) { return pose_of(scan); });
}

void Building::draw_first(size_t drives, ale_map_t *out) const
{
    const size_t last = drives < first_scan_.size() ? first_scan_[drives] : poses_.size();
    ale::rebuild_map(
        record_,
        [&](const ale::RecordedScan &scan) { return scan.scan < last ? pose_of(scan) : std::nullopt; }, out);
}

ale::ScanCloud Building::cloud() const
{
    ale::ScanCloud cloud;
    for (const ale::RecordedScan &scan : record_.scans()) {
        const std::optional<ale_pose_t> pose = pose_of(scan);
        if (scan.beams && pose) {
            cloud.add(*scan.beams, ale_pose_compose(*pose, record_.sensor(scan)));
        }
    }
    return cloud;
}

} // namespace merge
