extern "C" {
#include "graph/mapper.h"
}

#include <cmath>
#include <new>

#include "graph/loop_closer.h"
#include "graph/scan_node.h"

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
    uint32_t epoch = 0;
    ale::LoopCloser closer;
    std::vector<Pose> known;      // each keyframe as the tracker places it
    std::vector<Pose> last_shift; // of each correction handed out
    uint32_t refused = 0;
};

namespace
{

// Where the tracker sees the keyframe, moved by the corrections that it had not heard of.
Pose where_it_is(const ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    Pose pose = ale::from_core(keyframe.map);
    for (size_t k = keyframe.corrections; k < mapper.last_shift.size(); k++) {
        pose = ale::compose(mapper.last_shift[k], pose);
    }
    return pose;
}

void begin_anew(ale_mapper &mapper)
{
    const uint32_t refused = mapper.refused;
    mapper = ale_mapper{};
    mapper.refused = refused;
}

void add(ale_mapper &mapper, const ale_keyframe_t &keyframe)
{
    if (keyframe.epoch != mapper.epoch) {
        begin_anew(mapper);
        mapper.epoch = keyframe.epoch;
    }
    ale::Node node = ale::node_of(keyframe);
    const Pose pose = where_it_is(mapper, keyframe);
    Pose motion;
    if (!mapper.known.empty()) {
        motion = ale::between(mapper.known.back(), pose);
        node.path_m = mapper.closer.nodes().back().path_m + ale::length(motion.x, motion.y);
    }
    mapper.known.push_back(pose);
    mapper.closer.add(std::move(node), mapper.known.size() == 1 ? pose : motion);
}

} // namespace

ale_mapper_t *ale_mapper_create(void)
{
    return new (std::nothrow) ale_mapper;
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

bool ale_mapper_correction(ale_mapper_t *mapper, ale_correction_t *out)
{
    const std::vector<Pose> &now = mapper->closer.poses();
    bool worth = false;
    for (size_t k = 0; k < now.size(); k++) {
        worth = worth || is_worth_it(mapper->known[k], now[k]);
    }
    if (!worth) {
        return false;
    }
    // more keyframes than shifts: every so many share one; the last keyframe always has its own
    const size_t every = (now.size() - 1) / ALE_CORRECTION_SHIFTS + 1;
    out->epoch = mapper->epoch;
    out->due = mapper->closer.nodes().back().scan + ALE_CORRECTION_DELAY_SCANS;
    out->count = 0;
    for (size_t back = (now.size() - 1) % every; back < now.size(); back += every) {
        out->shift[out->count++] = {mapper->closer.nodes()[back].scan,
                                    ale::to_core(shift_of(mapper->known[back], now[back]))};
    }
    mapper->last_shift.push_back(shift_of(mapper->known.back(), now.back()));
    mapper->known = now;
    return true;
}

ale_mapper_statistics_t ale_mapper_statistics(const ale_mapper_t *mapper)
{
    const ale::LoopStatistics &s = mapper->closer.statistics();
    return {static_cast<uint32_t>(mapper->known.size()),
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
