// A drive of more than one lap, of which the middle lies in a map of its own until the tracker joins that.
#ifndef TESTS_GRAPH_JOINED_DRIVE_HPP
#define TESTS_GRAPH_JOINED_DRIVE_HPP

#include "maps_drive.hpp"

namespace joined_drive
{

constexpr size_t begun = 90;   // keyframe with which the second map begins: beyond half a lap
constexpr size_t joined = 150; // and that with which it joins: at the beginning of the second lap
constexpr double laps = 1.15;
constexpr size_t lap = 144;

// The second map is off by `elsewhere` until the tracker recognises what it saw a lap before.
inline maps_drive::Keyframes keyframes(double bend_rad_m)
{
    using namespace maps_drive;
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    Keyframes keyframes = drifting_keyframes::walk(laps, bend_rad_m, 3);
    const ale::Pose earlier = ale::from_core(keyframes[joined - lap]->map);
    const ale_pose_t recognised =
        ale::to_core(ale::compose(earlier, ale::between(truth[joined - lap], truth[joined])));
    const ale_pose_t shift = ale_pose_compose(recognised, undo(keyframes[joined]->map));
    begin_map(keyframes, begun, joined, 1, elsewhere());
    for (size_t k = joined; k < keyframes.size(); k++) {
        keyframes[k]->map = ale_pose_compose(shift, keyframes[k]->map);
    }
    tell_join(keyframes, joined, {1, 1, 0, ale_pose_compose(shift, undo(elsewhere()))});
    return keyframes;
}

} // namespace joined_drive

#endif
