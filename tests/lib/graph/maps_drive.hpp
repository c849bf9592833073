// A drive in several maps, as the tracker tells it: keyframes of the corridor around a block, of which some
// lie in a frame of their own, until that map joins another.
#ifndef TESTS_GRAPH_MAPS_DRIVE_HPP
#define TESTS_GRAPH_MAPS_DRIVE_HPP

#include <memory>
#include <vector>

#include "drifting_keyframes.hpp"

extern "C" {
#include "graph/mapper.h"
}

namespace maps_drive
{

struct DestroyMapper {
    void operator()(ale_mapper_t *mapper) const
    {
        ale_mapper_destroy(mapper);
    }
};
using Mapper = std::unique_ptr<ale_mapper_t, DestroyMapper>;
using Correction = std::unique_ptr<ale_correction_t>;
using Keyframes = std::vector<drifting_keyframes::Keyframe>;

// Where the prediction has put the second map: nowhere near.
inline ale_pose_t elsewhere()
{
    return ale::to_core({5, -3, 0.7});
}

inline ale_pose_t undo(const ale_pose_t &shift)
{
    return ale::to_core(ale::inverse(ale::from_core(shift)));
}

// Keyframes first..last - 1 are of a new map, whose frame is off by this, and of which this is claimed.
inline void begin_map(const Keyframes &keyframes, size_t first, size_t last, uint32_t map_id, ale_pose_t off,
                      ale_claim_t claim = ALE_CLAIM_NEAR)
{
    for (size_t k = first; k < std::min(last, keyframes.size()); k++) {
        keyframes[k]->map_id = map_id;
        keyframes[k]->claim = claim;
        keyframes[k]->map = ale_pose_compose(off, keyframes[k]->map);
    }
    keyframes[first]->broken = true;
}

// From this keyframe on the tracker tells of this join.
inline void tell_join(const Keyframes &keyframes, size_t first, const ale_map_join_t &join)
{
    for (size_t k = first; k < keyframes.size(); k++) {
        keyframes[k]->join = join;
    }
}

inline void add(ale_mapper_t *mapper, const Keyframes &keyframes, size_t first, size_t last)
{
    for (size_t k = first; k < std::min(last, keyframes.size()); k++) {
        EXPECT_EQ(ale_mapper_add(mapper, keyframes[k].get()), 0);
    }
}

// Of keyframe k's node.
inline double error_m(const ale_mapper_t *mapper, size_t k, const ale::Pose &truth)
{
    const ale_pose_t pose = ale_mapper_pose(mapper, static_cast<uint32_t>(k)).pose;
    return std::hypot(pose.x_um * 1e-6 - truth.x, pose.y_um * 1e-6 - truth.y);
}

} // namespace maps_drive

#endif
