extern "C" {
#include "graph/live_map.h"
}

#include <algorithm>
#include <map>
#include <new>
#include <optional>

#include "graph/walls/line_ids.h"
#include "graph/walls/map_rebuild.h"
#include "graph/walls/wall_groups.h"

namespace
{

// Enough scans for the surroundings of a keyframe: more come only where the robot stays.
constexpr size_t max_scans_of_keyframe = 16;

// With what its lines take while the map is rebuilt.
size_t bytes_of(const ale::RecordedScan &scan)
{
    return sizeof scan + scan.lines.size() * (sizeof(ale_observation_t) + sizeof(ale::PlacedLine)) +
           scan.corners.size() * sizeof(ale_corner_t) + (scan.beams ? sizeof(ale_seen_copy_t) : 0);
}

bool is_earlier(const ale_mapper_pose_t &keyframe, uint32_t scan)
{
    return keyframe.scan < scan;
}

// The keyframe that a scan belongs to, if the mapper holds it; else nullptr.
const ale_mapper_pose_t *keyframe_of(const ale_mapper_poses_t &poses, const ale::RecordedScan &scan)
{
    const ale_mapper_pose_t *end = poses.pose + poses.count;
    const ale_mapper_pose_t *found = std::lower_bound(poses.pose, end, scan.keyframe, is_earlier);
    return found != end && found->scan == scan.keyframe ? found : nullptr;
}

bool is_thinned(const ale_mapper_poses_t &poses, const ale::RecordedScan &scan)
{
    const bool is_past = poses.count > 0 && scan.keyframe <= poses.pose[poses.count - 1].scan;
    return is_past && !keyframe_of(poses, scan);
}

// The map that the robot is in.
uint32_t present_map(const ale_mapper_poses_t &poses)
{
    return poses.count > 0 ? poses.pose[poses.count - 1].map_id : uint32_t{ALE_FIRST_MAP};
}

// By the corrected pose of its keyframe; as tracked if the mapper does not have that keyframe yet. None: of
// another map than the robot is in.
std::optional<ale_pose_t> pose_of(const ale_mapper_poses_t &poses, const ale::RecordedScan &scan)
{
    const ale_mapper_pose_t *keyframe = keyframe_of(poses, scan);
    if (keyframe && keyframe->map_id != present_map(poses)) {
        return std::nullopt;
    }
    return keyframe ? ale_pose_compose(ale_pose_shift(keyframe->smooth, keyframe->pose), scan.smooth)
                    : scan.tracked;
}

} // namespace

struct ale_live_map {
    ale::ObservationRecord record;
    ale::LineIds ids;
};

namespace
{

void remove_oldest_scan_of(ale::ObservationRecord &record, uint32_t keyframe)
{
    bool gone = false;
    record.remove([&](const ale::RecordedScan &scan) {
        const bool goes = !gone && scan.keyframe == keyframe;
        gone = gone || goes;
        return goes;
    });
}

void limit_scans_of_last_keyframe(ale::ObservationRecord &record)
{
    const uint32_t keyframe = record.scans().back().keyframe;
    size_t scans = 0;
    for (auto s = record.scans().rbegin(); s != record.scans().rend() && s->keyframe == keyframe; ++s) {
        scans++;
    }
    if (scans > max_scans_of_keyframe) {
        remove_oldest_scan_of(record, keyframe);
    }
}

size_t bytes_of(const ale::ObservationRecord &record)
{
    size_t sum = record.prior_lines().size() * (sizeof(ale_map_line_t) + sizeof(ale::PlacedLine)) +
                 record.prior_corners().size() * sizeof(ale_map_corner_t);
    for (const ale::RecordedScan &scan : record.scans()) {
        sum += bytes_of(scan);
    }
    return sum;
}

// The keyframe that takes most memory; the earliest of equals.
uint32_t largest_keyframe(const ale::ObservationRecord &record)
{
    std::map<uint32_t, size_t> bytes;
    for (const ale::RecordedScan &scan : record.scans()) {
        bytes[scan.keyframe] += bytes_of(scan);
    }
    const auto is_less = [](const auto &a, const auto &b) { return a.second < b.second; };
    return std::max_element(bytes.begin(), bytes.end(), is_less)->first;
}

void limit_memory(ale::ObservationRecord &record)
{
    while (bytes_of(record) > ALE_LIVE_MAP_BYTES) {
        remove_oldest_scan_of(record, largest_keyframe(record));
    }
}

void build(ale_live_map &live, const ale_mapper_poses_t &poses, ale_map_t *out)
{
    live.record.remove([&](const ale::RecordedScan &scan) { return is_thinned(poses, scan); });
    const auto prior =
        present_map(poses) == ALE_FIRST_MAP ? ale::PriorWalls::counted : ale::PriorWalls::left_out;
    ale::rebuild_map(
        live.record, [&](const ale::RecordedScan &scan) { return pose_of(poses, scan); }, out, prior);
    live.ids.assign(out);
}

} // namespace

ale_live_map_t *ale_live_map_create(void)
{
    return new (std::nothrow) ale_live_map;
}

void ale_live_map_destroy(ale_live_map_t *live)
{
    delete live;
}

int ale_live_map_set_prior_map(ale_live_map_t *live, uint32_t epoch, const ale_map_t *map)
{
    try {
        live->record.set_prior_map(epoch, *map);
        return 0;
    } catch (const std::bad_alloc &) {
        live->record = ale::ObservationRecord();
        return -1;
    }
}

int ale_live_map_add(ale_live_map_t *live, const ale_scan_observation_t *observation)
{
    try {
        live->record.add(*observation);
        limit_scans_of_last_keyframe(live->record);
        limit_memory(live->record);
        return 0;
    } catch (const std::bad_alloc &) {
        return -1;
    }
}

bool ale_live_map_build(ale_live_map_t *live, const ale_mapper_poses_t *poses, ale_map_t *out)
{
    if (live->record.epoch() == 0 || poses->epoch != live->record.epoch()) {
        return false;
    }
    try {
        build(*live, *poses, out);
        return out->line_count > 0;
    } catch (const std::bad_alloc &) {
        return false;
    }
}

uint32_t ale_live_map_epoch(const ale_live_map_t *live)
{
    return live->record.epoch();
}

uint32_t ale_live_map_bytes(const ale_live_map_t *live)
{
    return static_cast<uint32_t>(bytes_of(live->record));
}
