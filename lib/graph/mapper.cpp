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

// Smaller moves cause no correction of the map.
constexpr double least_move_m = 0.005;
constexpr double least_move_rad = 0.001;

// The transform from points placed by `before` to the same points placed by `after`.
Pose shift_of(const Pose &before, const Pose &after)
{
    return ale::compose(after, ale::inverse(before));
}

bool has_moved(const Pose &before, const Pose &after)
{
    return ale::length(after.x - before.x, after.y - before.y) > least_move_m ||
           std::abs(ale::wrapped(after.theta - before.theta)) > least_move_rad;
}

} // namespace

struct ale_mapper {
    explicit ale_mapper(size_t keyframes) : closer(keyframes)
    {
    }

    uint32_t epoch = 0;
    ale::LoopCloser closer;
    uint32_t applied = 0;            // corrections that the tracker had applied by the last keyframe
    std::deque<Pose> pending_shifts; // last shift of each correction handed out since
    uint32_t refused = 0;
};

namespace
{

// The tracker's pose of the keyframe, moved by the corrections that it had not applied yet.
Pose corrected_pose(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    for (; mapper.applied < keyframe.corrections; mapper.applied++) {
        if (!mapper.pending_shifts.empty()) {
            mapper.pending_shifts.pop_front();
        }
    }
    Pose pose = ale::from_core(keyframe.map);
    for (const Pose &shift : mapper.pending_shifts) {
        pose = ale::compose(shift, pose);
    }
    return pose;
}

void reset(ale_mapper &mapper)
{
    mapper.closer.reset();
    mapper.epoch = 0;
    mapper.applied = 0;
    mapper.pending_shifts.clear();
}

void add(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    if (keyframe.epoch != mapper.epoch) {
        reset(mapper);
        mapper.epoch = keyframe.epoch;
    }
    ale::Node node = ale::node_of(keyframe);
    node.tracked = corrected_pose(mapper, keyframe);
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
        reset(*mapper); // the graph may hold half of the keyframe
        mapper->refused++;
        return -1;
    }
}

int ale_mapper_set_prior_map(ale_mapper_t *mapper, uint32_t epoch, const ale_map_t *map)
{
    reset(*mapper);
    mapper->epoch = epoch;
    try {
        mapper->closer.set_prior_map(*map);
        return 0;
    } catch (const std::bad_alloc &) {
        return -1;
    }
}

void ale_mapper_add_walls(ale_mapper_t *mapper, const ale_pose_t *smooth, const ale_pose_t *sensor,
                          const ale_features_t *features)
{
    try {
        mapper->closer.add_walls(ale::from_core(*smooth), ale::walls_of(*features, ale::from_core(*sensor)));
    } catch (const std::bad_alloc &) {
        return; // the building direction goes without this scan
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
    bool moved = false;
    for (size_t k = 0; k < now.size(); k++) {
        moved = moved || has_moved(nodes[k].tracked, now[k]);
    }
    if (!moved) {
        return false;
    }
    out->epoch = mapper->epoch;
    out->due = nodes.back().scan + ALE_CORRECTION_DELAY_SCANS;
    out->count = 0;
    for (size_t k = 0; k < now.size(); k++) {
        out->shift[out->count++] = {nodes[k].scan, ale::to_core(shift_of(nodes[k].tracked, now[k]))};
    }
    try {
        mapper->pending_shifts.push_back(shift_of(nodes.back().tracked, now.back()));
    } catch (const std::bad_alloc &) {
        return false; // the next correction will contain this one
    }
    mapper->closer.mark_handed_out();
    out->number = mapper->applied + static_cast<uint32_t>(mapper->pending_shifts.size());
    return true;
}

ale_mapper_statistics_t ale_mapper_statistics(const ale_mapper_t *mapper)
{
    const ale::LoopStatistics &s = mapper->closer.statistics();
    return {static_cast<uint32_t>(mapper->closer.nodes().size()),
            s.thinned,
            s.candidates,
            s.recognised,
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
