extern "C" {
#include "graph/mapper.h"
}

#include <algorithm>
#include <cmath>
#include <deque>
#include <new>

#include "graph/graph_selection.h"
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
    uint32_t joins_heard = 0;        // number of the tracker's last join
    uint32_t join_number = 0;        // of the correction under way that joins two maps; 0: none
    uint32_t refused = 0;
    std::deque<ale_tile_change_t> tiles; // that wait for their scan
};

namespace
{

// Corrections that the tracker has applied no longer wait.
void forget_applied(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    for (; mapper.applied < keyframe.corrections; mapper.applied++) {
        if (!mapper.pending_shifts.empty()) {
            mapper.pending_shifts.pop_front();
        }
    }
    if (mapper.join_number != 0 && mapper.applied >= mapper.join_number) {
        mapper.join_number = 0;
        mapper.closer.make_found_join();
    }
}

// The tracker's pose of the keyframe, moved by the corrections that it had not applied yet.
Pose corrected_pose(const ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    Pose pose = ale::from_core(keyframe.map);
    for (const Pose &shift : mapper.pending_shifts) {
        pose = ale::compose(shift, pose);
    }
    return pose;
}

// The tracker has joined a map by itself: a join that was found here and is under way is void if it is of
// that map.
void drop_found_join(ale_mapper &mapper, uint32_t map_id)
{
    if (mapper.join_number == 0) {
        mapper.closer.forget_found_join();
    } else if (mapper.closer.found_join()->join.map_id == map_id) {
        mapper.join_number = 0;
        mapper.closer.withdraw_join();
        mapper.pending_shifts.back() = {};
    }
}

// The tracker has joined two maps. Corrections that it has not applied yet it will apply to what has moved by
// then: as seen from there. Of several joins since the last keyframe only the last one is known; maps that
// the others joined stay apart.
void hear_of_join(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    const ale_map_join_t &join = keyframe.join;
    const bool is_heard = join.number <= mapper.joins_heard;
    const bool others_lost = join.number > mapper.joins_heard + 1;
    mapper.joins_heard = join.number;
    const uint32_t map_id = mapper.closer.map_now(join.map_id);
    const uint32_t into_map_id = mapper.closer.map_now(join.into_map_id);
    if (is_heard || mapper.closer.nodes().empty()) {
        return;
    }
    if (others_lost) {
        mapper.closer.lose_track_of_maps(into_map_id);
    }
    if (map_id == into_map_id) {
        return; // as found here
    }
    drop_found_join(mapper, map_id);
    const Pose moved = ale::from_core(join.shift);
    for (Pose &shift : mapper.pending_shifts) {
        shift = ale::compose(moved, ale::compose(shift, ale::inverse(moved)));
    }
    mapper.closer.join({map_id, into_map_id, moved}, corrected_pose(mapper, keyframe));
}

void reset(ale_mapper &mapper)
{
    mapper.joins_heard = 0;
    mapper.join_number = 0;
    mapper.closer.reset();
    mapper.epoch = 0;
    mapper.applied = 0;
    mapper.pending_shifts.clear();
}

// Tiles that are due by the scan of the keyframe; those of an epoch that is over are void.
void take_tiles(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    while (!mapper.tiles.empty() && mapper.tiles.front().epoch <= keyframe.epoch) {
        const bool ours = mapper.tiles.front().epoch == keyframe.epoch;
        if (ours && mapper.tiles.front().due > keyframe.scan) {
            return;
        }
        if (ours) {
            mapper.closer.change_tiles(mapper.tiles.front());
        }
        mapper.tiles.pop_front();
    }
}

void add(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    if (keyframe.epoch != mapper.epoch) {
        reset(mapper);
        mapper.epoch = keyframe.epoch;
    }
    take_tiles(mapper, keyframe);
    forget_applied(mapper, keyframe);
    hear_of_join(mapper, keyframe);
    ale::Node node = ale::node_of(keyframe);
    node.map_id = mapper.closer.map_now(keyframe.map_id);
    node.tracked = corrected_pose(mapper, keyframe);
    Pose motion = node.tracked;
    if (!mapper.closer.nodes().empty()) {
        const ale::Node &before = mapper.closer.nodes().back();
        motion = ale::between(before.tracked, node.tracked);
        node.path_m = before.path_m + ale::length(motion.x, motion.y);
    }
    mapper.closer.add(std::move(node), motion);
}

// The head of a correction; its shifts are to be appended, in the order of the nodes. May throw.
void begin_correction(ale_mapper &mapper, const Pose &last_shift, ale_correction_t *out)
{
    mapper.pending_shifts.push_back(last_shift);
    out->epoch = mapper.epoch;
    out->number = mapper.applied + static_cast<uint32_t>(mapper.pending_shifts.size());
    out->due = mapper.closer.nodes().back().scan + ALE_CORRECTION_DELAY_SCANS;
    out->count = 0;
    out->joins = false;
    out->joined_map_id = out->into_map_id = ALE_FIRST_MAP;
}

// All that has moved since the last correction. False: nothing.
bool fill_moves(ale_mapper &mapper, ale_correction_t *out)
{
    const std::vector<Pose> &now = mapper.closer.poses();
    const std::vector<ale::Node> &nodes = mapper.closer.nodes();
    bool moved = false;
    for (size_t k = 0; k < now.size(); k++) {
        moved = moved || has_moved(nodes[k].tracked, now[k]);
    }
    if (!moved) {
        return false;
    }
    begin_correction(mapper, shift_of(nodes.back().tracked, now.back()), out);
    for (size_t k = 0; k < now.size(); k++) {
        out->shift[out->count++] = {nodes[k].scan, ale::to_core(shift_of(nodes[k].tracked, now[k]))};
    }
    mapper.closer.mark_handed_out();
    return true;
}

// The join that was found, alone, so that it can be void as a whole. False: none was found.
bool fill_join(ale_mapper &mapper, ale_correction_t *out)
{
    if (!mapper.closer.found_join()) {
        return false;
    }
    const ale::MapJoin &join = mapper.closer.found_join()->join;
    const std::vector<ale::Node> &nodes = mapper.closer.nodes();
    const auto shift = [&join](const ale::Node &node) {
        return node.map_id == join.map_id ? join.shift : Pose{};
    };
    begin_correction(mapper, shift(nodes.back()), out);
    for (const ale::Node &node : nodes) {
        out->shift[out->count++] = {node.scan, ale::to_core(shift(node))};
    }
    out->joins = true;
    out->joined_map_id = join.map_id;
    out->into_map_id = join.into_map_id;
    mapper.join_number = out->number;
    mapper.closer.mark_join_handed_out();
    return true;
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

int ale_mapper_change_tiles(ale_mapper_t *mapper, const ale_tile_change_t *change)
{
    try {
        mapper->tiles.push_back(*change);
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
        if (mapper->join_number != 0) { // the tracker will apply it
            mapper->join_number = 0;
            mapper->closer.make_found_join();
        }
        return mapper->closer.refine();
    } catch (const std::bad_alloc &) {
        return false;
    }
}

bool ale_mapper_correction(ale_mapper_t *mapper, ale_correction_t *out)
{
    if (mapper->join_number != 0) {
        return false; // until the tracker has made that join
    }
    try {
        return fill_moves(*mapper, out) || fill_join(*mapper, out);
    } catch (const std::bad_alloc &) {
        return false; // the next correction will contain this one
    }
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
            mapper->refused,
            static_cast<uint32_t>(ale::count_maps(mapper->closer.nodes())),
            s.joins};
}

ale_mapper_pose_t ale_mapper_pose(const ale_mapper_t *mapper, uint32_t k)
{
    return {mapper->closer.nodes()[k].scan, ale::to_core(mapper->closer.nodes()[k].smooth),
            ale::to_core(mapper->closer.poses()[k]), mapper->closer.nodes()[k].map_id};
}

void ale_mapper_poses(const ale_mapper_t *mapper, ale_mapper_poses_t *out)
{
    out->epoch = mapper->epoch;
    out->count = static_cast<uint32_t>(mapper->closer.nodes().size());
    for (uint32_t k = 0; k < out->count; k++) {
        out->pose[k] = ale_mapper_pose(mapper, k);
    }
}

bool ale_mapper_graph(const ale_mapper_t *mapper, ale_mapper_graph_t *out)
{
    try {
        const ale::LoopCloser &closer = mapper->closer;
        ale::select_graph(closer.nodes(), closer.poses(), closer.edges(), out);
        out->epoch = mapper->epoch;
        return true;
    } catch (const std::bad_alloc &) {
        return false;
    }
}
