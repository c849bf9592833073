extern "C" {
#include "graph/mapper.h"
}

#include <algorithm>
#include <cmath>
#include <deque>
#include <new>

#include "graph/loops/loop_closer.h"
#include "graph/optimise/scan_node.h"

namespace
{

using ale::Pose;

// Moves smaller than this are not worth a correction of the map.
constexpr double worth_m = 0.005;
constexpr double worth_rad = 0.001;

// The transform that takes points placed by `before` to where `after` puts them.
Pose shift_of(const Pose &before, const Pose &after)
{
    return ale::compose(after, ale::inverse(before));
}

bool is_worth_it(const Pose &before, const Pose &after)
{
    return ale::length(after.x - before.x, after.y - before.y) > worth_m ||
           std::abs(ale::wrapped(after.theta - before.theta)) > worth_rad;
}

} // namespace

struct ale_mapper {
    explicit ale_mapper(size_t keyframes) : closer(keyframes)
    {
    }

    uint32_t epoch = 0;
    ale::LoopCloser closer;
    uint32_t heard = 0;          // corrections that the tracker had taken in with the last keyframe
    std::deque<Pose> last_shift; // of each correction handed out since
    uint32_t refused = 0;
};

namespace
{

// Where the tracker sees the keyframe, moved by the corrections that it had not heard of.
Pose where_it_is(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    for (; mapper.heard < keyframe.corrections; mapper.heard++) {
        if (!mapper.last_shift.empty()) {
            mapper.last_shift.pop_front();
        }
    }
    Pose pose = ale::from_core(keyframe.map);
    for (const Pose &shift : mapper.last_shift) {
        pose = ale::compose(shift, pose);
    }
    return pose;
}

void begin_anew(ale_mapper &mapper)
{
    mapper.closer.begin_anew();
    mapper.epoch = 0;
    mapper.heard = 0;
    mapper.last_shift.clear();
}

void add(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    if (keyframe.epoch != mapper.epoch) {
        begin_anew(mapper);
        mapper.epoch = keyframe.epoch;
    }
    ale::Node node = ale::node_of(keyframe);
    node.tracked = where_it_is(mapper, keyframe);
    Pose motion = node.tracked;
    if (!mapper.closer.nodes().empty()) {
        const ale::Node &before = mapper.closer.nodes().back();
        motion = ale::between(before.tracked, node.tracked);
        node.path_m = before.path_m + ale::length(motion.x, motion.y);
    }
    mapper.closer.add(std::move(node), motion);
}

} // namespace

ale_mapper_t *ale_mapper_create(uint32_t keyframes)
{
    try {
        return new ale_mapper(std::min<size_t>(keyframes, ALE_CORRECTION_SHIFTS));
    } catch (const std::bad_alloc &) {
        return nullptr;
    }
}

void ale_mapper_destroy(ale_mapper_t *mapper)
{
    delete mapper;
}

int ale_mapper_add(ale_mapper_t *mapper, const ale_keyframe_t *keyframe)
{
    try {
        add(*mapper, *keyframe);
        return 0;
    } catch (const std::bad_alloc &) {
        begin_anew(*mapper); // half of what was under way is in it
        mapper->refused++;
        return -1;
    }
}

int ale_mapper_know(ale_mapper_t *mapper, uint32_t epoch, const ale_map_t *map)
{
    begin_anew(*mapper);
    mapper->epoch = epoch;
    try {
        mapper->closer.know(*map);
        return 0;
    } catch (const std::bad_alloc &) {
        return -1;
    }
}

void ale_mapper_see_walls(ale_mapper_t *mapper, const ale_pose_t *smooth, const ale_pose_t *sensor,
                          const ale_features_t *features)
{
    try {
        mapper->closer.see_walls(ale::from_core(*smooth), ale::walls_of(*features, ale::from_core(*sensor)));
    } catch (const std::bad_alloc &) {
        return; // a compass with one scan less
    }
}

bool ale_mapper_refine(ale_mapper_t *mapper)
{
    try {
        return mapper->closer.refine();
    } catch (const std::bad_alloc &) {
        return false;
    }
}

bool ale_mapper_correction(ale_mapper_t *mapper, ale_correction_t *out)
{
    const std::vector<Pose> &now = mapper->closer.poses();
    const std::vector<ale::Node> &nodes = mapper->closer.nodes();
    bool worth = false;
    for (size_t k = 0; k < now.size(); k++) {
        worth = worth || is_worth_it(nodes[k].tracked, now[k]);
    }
    if (!worth) {
        return false;
    }
    out->epoch = mapper->epoch;
    out->due = nodes.back().scan + ALE_CORRECTION_DELAY_SCANS;
    out->count = 0;
    for (size_t k = 0; k < now.size(); k++) {
        out->shift[out->count++] = {nodes[k].scan, ale::to_core(shift_of(nodes[k].tracked, now[k]))};
    }
    mapper->last_shift.push_back(shift_of(nodes.back().tracked, now.back()));
    mapper->closer.told();
    out->number = mapper->heard + static_cast<uint32_t>(mapper->last_shift.size());
    return true;
}

ale_mapper_statistics_t ale_mapper_statistics(const ale_mapper_t *mapper)
{
    const ale::LoopStatistics &s = mapper->closer.statistics();
    return {static_cast<uint32_t>(mapper->closer.nodes().size()),
            s.thinned,
            s.candidates,
            s.known,
            s.unclear,
            s.unconfirmed,
            s.contradicted,
            s.loops,
            mapper->refused};
}

ale_mapper_pose_t ale_mapper_pose(const ale_mapper_t *mapper, uint32_t k)
{
    return {mapper->closer.nodes()[k].scan, ale::to_core(mapper->closer.nodes()[k].smooth),
            ale::to_core(mapper->closer.poses()[k])};
}

void ale_mapper_poses(const ale_mapper_t *mapper, ale_mapper_poses_t *out)
{
    out->epoch = mapper->epoch;
    out->count = static_cast<uint32_t>(mapper->closer.nodes().size());
    for (uint32_t k = 0; k < out->count; k++) {
        out->pose[k] = ale_mapper_pose(mapper, k);
    }
}
