#include "operator/ros2/markers.h"

#include <array>

#include "operator/ros2/geometry.h"

namespace ros2
{

namespace
{

using Colour = std_msgs_msg_dds__ColorRGBA_;
using Points = std::vector<geometry_msgs_msg_dds__Point_>;

constexpr Colour line_colour = {0.1F, 0.5F, 1, 1};
constexpr Colour corner_colour = {1, 0.4F, 0.1F, 1};
constexpr Colour wall_colour = {0.9F, 0.9F, 0.9F, 1};
constexpr Colour apart_colour = {0.7F, 0.3F, 1, 1};
constexpr Colour keyframe_colour = {0.7F, 0.85F, 0.3F, 1};
constexpr Colour loop_colour = {1, 0.35F, 0.25F, 1};
constexpr Colour plan_colour = {0.2F, 0.9F, 0.4F, 1};
constexpr double corner_m = 0.08;
constexpr double keyframe_m = 0.08;

geometry_msgs_msg_dds__Point_ point(float x, float y)
{
    return {static_cast<double>(x), static_cast<double>(y), 0};
}

template <class Line> void add_line(Points &points, const Line &line)
{
    points.push_back(point(line.x1, line.y1));
    points.push_back(point(line.x2, line.y2));
}

void add_edge(Points &points, const ale::graph_t &graph, size_t from, size_t to)
{
    points.push_back(point(graph.x[from], graph.y[from]));
    points.push_back(point(graph.x[to], graph.y[to]));
}

visualization_msgs_msg_dds__Marker_ marker(Drawing &drawing, const Shown &shown, std::string &frame)
{
    constexpr int32_t remove_marker = 2; /* DELETE */
    constexpr int64_t second_us = 1000000;
    static std::string none;
    visualization_msgs_msg_dds__Marker_ out{};
    out.header = {ros_time(shown.utime), frame.data()};
    out.ns = drawing.name.data();
    out.type = static_cast<int32_t>(drawing.shape);
    out.action = drawing.points.empty() ? remove_marker : 0;
    out.pose = ros_pose({0, 0, 0});
    out.scale = {drawing.size_m, drawing.size_m, drawing.size_m};
    out.color = drawing.colour;
    out.lifetime = {static_cast<int32_t>(shown.lifetime_us / second_us),
                    static_cast<uint32_t>(shown.lifetime_us % second_us * 1000)};
    out.points = sequence_of<decltype(out.points)>(drawing.points);
    out.texture_resource = out.text = out.mesh_resource = none.data();
    out.texture.header.frame_id = out.texture.format = out.mesh_file.filename = none.data();
    return out;
}

} // namespace

std::vector<Drawing> drawings_of(const ale::features_t &features)
{
    Drawing lines = {"lines", Shape::lines, 0.03, line_colour, {}};
    Drawing corners = {"corners", Shape::balls, corner_m, corner_colour, {}};
    for (const ale::line_t &line : features.lines) {
        add_line(lines.points, line);
    }
    for (const ale::corner_t &corner : features.corners) {
        corners.points.push_back(point(corner.x, corner.y));
    }
    return {lines, corners};
}

std::vector<Drawing> drawings_of(const ale::map_t &map, const feed::MapPieces &pieces)
{
    constexpr double wall_m = 0.05;
    Drawing walls = {"walls", Shape::lines, wall_m, wall_colour, {}};
    Drawing apart = {"walls apart", Shape::lines, wall_m, apart_colour, {}};
    for (const ale::map_line_t &line : map.lines) {
        add_line((pieces.map_of(map.version, line.id) == 0 ? walls : apart).points, line);
    }
    return {walls, apart};
}

std::vector<Drawing> drawings_of(const ale::graph_t &graph)
{
    constexpr double tie_m = 0.02;
    std::array<Drawing, 2> dots = {{{"keyframes", Shape::balls, keyframe_m, keyframe_colour, {}},
                                    {"keyframes apart", Shape::balls, keyframe_m, apart_colour, {}}}};
    std::array<Drawing, 2> ties = {{{"ties", Shape::lines, tie_m, keyframe_colour, {}},
                                    {"ties apart", Shape::lines, tie_m, apart_colour, {}}}};
    std::array<Drawing, 3> loops = {{{"recognised", Shape::lines, 0.01, loop_colour, {}},
                                     {"closed", Shape::lines, 0.02, loop_colour, {}},
                                     {"joined", Shape::lines, 0.03, loop_colour, {}}}};
    for (size_t k = 0; k < graph.x.size(); k++) {
        const size_t apart = graph.map_id[k] == 0 ? 0 : 1;
        dots[apart].points.push_back(point(graph.x[k], graph.y[k]));
        if (k > 0 && graph.tied[k] != 0) {
            add_edge(ties[apart].points, graph, k - 1, k);
        }
    }
    for (size_t k = 0; k < graph.loop_from.size(); k++) {
        add_edge(loops[static_cast<size_t>(graph.loop_kind[k])].points, graph,
                 static_cast<size_t>(graph.loop_from[k]), static_cast<size_t>(graph.loop_to[k]));
    }
    return {dots[0], dots[1], ties[0], ties[1], loops[0], loops[1], loops[2]};
}

std::vector<Drawing> drawings_of(const ale::plan_t &plan)
{
    Drawing way = {"way", Shape::strip, 0.06, plan_colour, {}};
    Drawing place = {"place", Shape::balls, 0.2, plan_colour, {}};
    for (size_t k = 0; k < plan.x.size(); k++) {
        way.points.push_back(point(plan.x[k], plan.y[k]));
    }
    if (plan.has_place != 0) {
        place.points.push_back(point(plan.place_x, plan.place_y));
    }
    return {way, place};
}

std::vector<visualization_msgs_msg_dds__Marker_> markers_of(std::vector<Drawing> &drawings,
                                                            const Shown &shown, std::string &frame)
{
    std::vector<visualization_msgs_msg_dds__Marker_> markers;
    for (Drawing &drawing : drawings) {
        markers.push_back(marker(drawing, shown, frame));
    }
    return markers;
}

} // namespace ros2
