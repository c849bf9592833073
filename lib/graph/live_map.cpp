extern "C" {
#include "graph/live_map.h"
}

#include <algorithm>
#include <map>
#include <new>

#include "graph/walls/line_ids.h"
#include "graph/walls/map_redraw.h"
#include "graph/walls/wall_groups.h"

namespace
{

// A keyframe's surroundings are told by so many scans: more come only where the robot stays.
constexpr size_t scans_of_a_keyframe = 16;

// With the place that its lines take in a drawing.
size_t bytes_of(const ale::Sight &sight)
{
    return sizeof sight + sight.lines.size() * (sizeof(ale_observation_t) + sizeof(ale::PlacedLine)) +
           sight.corners.size() * sizeof(ale_corner_t) + (sight.look ? sizeof(ale_seen_copy_t) : 0);
}

bool is_earlier(const ale_mapper_pose_t &keyframe, uint32_t scan)
{
    return keyframe.scan < scan;
}

// What the mapper holds of the keyframe that a sight belongs to.
const ale_mapper_pose_t *keyframe_of(const ale_mapper_poses_t &poses, const ale::Sight &sight)
{
    const ale_mapper_pose_t *end = poses.pose + poses.count;
    const ale_mapper_pose_t *found = std::lower_bound(poses.pose, end, sight.keyframe, is_earlier);
    return found != end && found->scan == sight.keyframe ? found : nullptr;
}

bool is_thinned(const ale_mapper_poses_t &poses, const ale::Sight &sight)
{
    const bool known = poses.count > 0 && sight.keyframe <= poses.pose[poses.count - 1].scan;
    return known && !keyframe_of(poses, sight);
}

// By its keyframe; one that the mapper has not heard of is where the tracker saw it.
ale_pose_t pose_of(const ale_mapper_poses_t &poses, const ale::Sight &sight)
{
    const ale_mapper_pose_t *keyframe = keyframe_of(poses, sight);
    return keyframe ? ale_pose_compose(ale_pose_shift(keyframe->smooth, keyframe->pose), sight.smooth)
                    : sight.tracked;
}

} // namespace

struct ale_live_map {
    ale::MapRecord record;
    ale::LineIds ids;
};

namespace
{

// The oldest scan of a keyframe goes.
void give_up_one_of(ale::MapRecord &record, uint32_t keyframe)
{
    bool gone = false;
    record.forget([&](const ale::Sight &sight) {
        const bool goes = !gone && sight.keyframe == keyframe;
        gone = gone || goes;
        return goes;
    });
}

void give_up_what_repeats(ale::MapRecord &record)
{
    const uint32_t keyframe = record.sights().back().keyframe;
    size_t scans = 0;
    for (auto s = record.sights().rbegin(); s != record.sights().rend() && s->keyframe == keyframe; ++s) {
        scans++;
    }
    if (scans > scans_of_a_keyframe) {
        give_up_one_of(record, keyframe);
    }
}

size_t bytes_of(const ale::MapRecord &record)
{
    size_t sum = record.known_lines().size() * (sizeof(ale_map_line_t) + sizeof(ale::PlacedLine)) +
                 record.known_corners().size() * sizeof(ale_map_corner_t);
    for (const ale::Sight &sight : record.sights()) {
        sum += bytes_of(sight);
    }
    return sum;
}

// The keyframe of which most is kept; the earliest of equals.
uint32_t largest_keyframe(const ale::MapRecord &record)
{
    std::map<uint32_t, size_t> bytes;
    for (const ale::Sight &sight : record.sights()) {
        bytes[sight.keyframe] += bytes_of(sight);
    }
    const auto is_less = [](const auto &a, const auto &b) { return a.second < b.second; };
    return std::max_element(bytes.begin(), bytes.end(), is_less)->first;
}

void keep_within_bounds(ale::MapRecord &record)
{
    while (bytes_of(record) > ALE_LIVE_MAP_BYTES) {
        give_up_one_of(record, largest_keyframe(record));
    }
}

void draw(ale_live_map &live, const ale_mapper_poses_t &poses, ale_map_t *out)
{
    live.record.forget([&](const ale::Sight &sight) { return is_thinned(poses, sight); });
    ale::redraw_map(
        live.record, [&](const ale::Sight &sight) { return pose_of(poses, sight); }, out);
    live.ids.name(out);
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

int ale_live_map_know(ale_live_map_t *live, uint32_t epoch, const ale_map_t *map)
{
    try {
        live->record.know(epoch, *map);
        return 0;
    } catch (const std::bad_alloc &) {
        live->record = ale::MapRecord();
        return -1;
    }
}

int ale_live_map_take(ale_live_map_t *live, const ale_scan_observation_t *sighting)
{
    try {
        live->record.take(*sighting);
        give_up_what_repeats(live->record);
        keep_within_bounds(live->record);
        return 0;
    } catch (const std::bad_alloc &) {
        return -1;
    }
}

bool ale_live_map_draw(ale_live_map_t *live, const ale_mapper_poses_t *poses, ale_map_t *out)
{
    if (live->record.epoch() == 0 || poses->epoch != live->record.epoch()) {
        return false;
    }
    try {
        draw(*live, *poses, out);
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
