/* What the robot sees, knows and plans as lists of lines and balls, and these as markers for RViz2. Pure
 * functions.
 *
 *   std::vector<Drawing> drawings = drawings_of(features);
 *   std::vector<...Marker_> markers = markers_of(drawings, {features.utime, lifetime_us}, frame);
 *
 * Colours are those of ale-foxglove; violet is what lies in a map that is not joined with the first. */
#ifndef ROS2_MARKERS_H
#define ROS2_MARKERS_H

#include <string>
#include <vector>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_t.hpp"
#include "ale/plan_t.hpp"
#include "common/feed/map_pieces.h"
#include "visualization_msgs.h"

namespace ros2
{

enum class Shape : int32_t { strip = 4, lines = 5, balls = 7 }; /* LINE_STRIP, LINE_LIST, SPHERE_LIST */

/* Points in metres; of lines two for each. size_m: thickness of lines, diameter of balls. */
struct Drawing {
    std::string name;
    Shape shape;
    double size_m;
    std_msgs_msg_dds__ColorRGBA_ colour;
    std::vector<geometry_msgs_msg_dds__Point_> points;
};

/* Lines and corners of a scan, as the laser sees them. */
std::vector<Drawing> drawings_of(const ale::features_t &features);
/* Walls of a whole map, and by themselves those that are in another map than the first. */
std::vector<Drawing> drawings_of(const ale::map_t &map, const feed::MapPieces &pieces);
/* Keyframes, what ties neighbours, loops: the thinner the less they moved. */
std::vector<Drawing> drawings_of(const ale::graph_t &graph);
/* The way that the robot drives by itself, and the place that was named. */
std::vector<Drawing> drawings_of(const ale::plan_t &plan);

struct Shown {
    int64_t utime;
    int64_t lifetime_us; /* gone then; 0: it stays until the next of its name */
};

/* One a drawing: gone at once where it has no points, since RViz2 takes no empty list. They live no longer
 * than drawings and frame. */
std::vector<visualization_msgs_msg_dds__Marker_> markers_of(std::vector<Drawing> &drawings,
                                                            const Shown &shown, std::string &frame);

} // namespace ros2

#endif
