/* What a message must keep to before anything is done with it: anybody on the network may send.
 * Each throws std::runtime_error naming what makes no sense. */
#ifndef ALE_COMMON_FEED_CHECKS_H
#define ALE_COMMON_FEED_CHECKS_H

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_pieces_t.hpp"
#include "ale/map_t.hpp"
#include "ale/odometry_t.hpp"
#include "ale/plan_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "base/limits.h"
#include "map/line_map.h"

extern "C" {
#include "lcm/report.h"
}

namespace feed
{

inline void require(bool sense, const char *what)
{
    if (!sense) {
        throw std::runtime_error(what);
    }
}

/* Numbers of a robot's world: finite, and none beyond a million metres, radians or microseconds. */
inline bool sane(std::initializer_list<float> values)
{
    return std::all_of(values.begin(), values.end(), [](float v) { return std::fabs(v) < 1e6F; });
}

inline void check(const ale::corner_t &corner)
{
    require(sane({corner.x, corner.y, corner.angle}), "corner out of this world");
}

inline void check(const ale::pose_t &pose)
{
    require(sane({pose.x, pose.y, pose.theta, pose.map_x, pose.map_y, pose.map_theta}),
            "pose out of this world");
    require(sane({pose.vx, pose.vy, pose.omega}), "velocity out of this world");
    require(pose.state >= 0 && pose.state <= 2, "unknown state");
    require(pose.scan >= 0, "negative number of a scan");
}

inline void check(const ale::odometry_t &sample)
{
    require(sane({sample.x, sample.y, sample.theta}), "odometry out of this world");
}

inline void check(const ale::features_t &features)
{
    require(sane({features.sensor_x, features.sensor_y, features.sensor_theta}),
            "mounting out of this world");
    for (const auto &line : features.lines) {
        require(sane({line.x1, line.y1, line.x2, line.y2}), "line out of this world");
    }
    for (const auto &corner : features.corners) {
        check(corner);
    }
}

inline void check(const ale::scan_t &scan)
{
    require(sane({scan.beam_time_us, scan.first_bearing, scan.step, scan.range_min, scan.range_max,
                  scan.sensor_x, scan.sensor_y, scan.sensor_theta}),
            "geometry out of this world");
    require(scan.num_ranges <= ALE_MAX_BEAMS && scan.num_codes == scan.num_ranges, "wrong number of beams");
    require(scan.range_unit_mm >= 0, "negative unit");
}

inline void check(const ale::map_t &map)
{
    for (const auto &line : map.lines) {
        require(sane({line.x1, line.y1, line.x2, line.y2}), "wall out of this world");
    }
    for (const auto &corner : map.corners) {
        check(corner);
    }
}

inline void check(const ale::map_pieces_t &pieces)
{
    require(pieces.num_lines <= ALE_MAP_MAX_LINES, "more walls than a map has");
}

inline void check(const ale::tracking_t &tracking)
{
    require(tracking.scan >= 0, "negative number of a scan");
    require(tracking.maps >= 0 && tracking.wheel_faults >= 0, "negative count");
    require(tracking.wheel_word.size() <= 32, "a word of a whole page");
}

inline void check(const ale::plan_t &plan)
{
    require(plan.state >= 0 && plan.state <= 5, "unknown state");
    require(plan.num_points <= ALE_PLAN_POINTS, "more points than a path has");
    require(sane({plan.place_x, plan.place_y}), "place out of this world");
    for (size_t k = 0; k < plan.x.size(); k++) {
        require(sane({plan.x[k], plan.y[k]}), "path out of this world");
    }
    require(plan.words.size() <= 200, "a reason of a whole page");
}

/* Each loop ends at keyframes that are there. */
inline void check(const ale::graph_t &graph)
{
    require(graph.num_keyframes <= ALE_GRAPH_KEYFRAMES && graph.num_loops <= ALE_GRAPH_LOOPS,
            "more keyframes or loops than a graph has");
    require(graph.keyframes_left_out >= 0 && graph.loops_left_out >= 0, "negative count");
    for (size_t k = 0; k < graph.x.size(); k++) {
        require(sane({graph.x[k], graph.y[k], graph.theta[k]}), "keyframe out of this world");
    }
    for (size_t k = 0; k < graph.loop_from.size(); k++) {
        require(graph.loop_from[k] >= 0 && graph.loop_from[k] < graph.loop_to[k] &&
                    graph.loop_to[k] < graph.num_keyframes,
                "a loop between no two keyframes");
        require(graph.loop_kind[k] >= 0 && graph.loop_kind[k] <= ALE_LOOP_JOINS, "unknown kind of a loop");
    }
}

/* A status has texts and counts only. */
inline void check(const ale::status_t &status)
{
    require(status.counter_name.size() == status.counter_value.size(), "counters without values");
}

} // namespace feed

#endif
