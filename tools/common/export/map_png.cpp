#include <algorithm>
#include <array>

#include "common/export/canvas.h"
#include "common/export/map_image.h"

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

constexpr int32_t longest_side = 1500; /* pixels, without the margins */
constexpr int32_t margin = 50;
constexpr int32_t footer = 60; /* for the scale bar */

/* Where the way ends at its start, the start shows around the end. */
constexpr int32_t start_radius = 10 * sub_pixels;
constexpr int32_t end_radius = 7 * sub_pixels;

constexpr Colour grid_colour = {228, 232, 238};
constexpr Colour point_colour = {92, 128, 168};
constexpr Colour wall_colour = {24, 31, 46};
constexpr Colour apart_colour = {134, 84, 205};
constexpr Colour path_colour = {222, 82, 48};
constexpr Colour start_colour = {38, 150, 84};
constexpr std::array<Colour, 3> change_colours = {{{38, 150, 84}, {240, 146, 20}, {214, 48, 49}}};
constexpr Colour white = {255, 255, 255};
constexpr Colour ink = {90, 98, 112};

/* The paper: where a point of the map lies on it. */
class Sheet
{
  public:
    explicit Sheet(const Extent &extent) : extent_(extent)
    {
        const int64_t width_um = std::max<int64_t>(int64_t{extent.right_um} - extent.left_um, 1);
        const int64_t height_um = std::max<int64_t>(int64_t{extent.top_um} - extent.bottom_um, 1);
        um_per_side_ = std::max(width_um, height_um);
        width_ = static_cast<int32_t>(width_um * longest_side / um_per_side_) + 2 * margin;
        height_ = static_cast<int32_t>(height_um * longest_side / um_per_side_) + 2 * margin + footer;
    }
    int32_t width() const
    {
        return width_;
    }
    int32_t height() const
    {
        return height_;
    }
    int32_t length(int64_t um) const
    {
        return static_cast<int32_t>(ale_round_div(um * longest_side * sub_pixels, um_per_side_));
    }
    Spot spot(const ale_point_t &p) const
    {
        return {margin * sub_pixels + length(int64_t{p.x_um} - extent_.left_um),
                margin * sub_pixels + length(int64_t{extent_.top_um} - p.y_um)};
    }
    const Extent &extent() const
    {
        return extent_;
    }

  private:
    Extent extent_;
    int64_t um_per_side_;
    int32_t width_;
    int32_t height_;
};

/* First multiple of the mesh from `from` on. */
int64_t first_line(int64_t from, int64_t mesh)
{
    const int64_t below = from / mesh * mesh;
    return below < from ? below + mesh : below;
}

void draw_grid(Canvas &canvas, const Sheet &sheet, int32_t mesh_um)
{
    Layer layer = canvas.layer();
    const Extent &e = sheet.extent();
    for (int64_t x = first_line(e.left_um, mesh_um); x <= e.right_um; x += mesh_um) {
        const auto x_um = static_cast<int32_t>(x);
        layer.stroke(sheet.spot({x_um, e.bottom_um}), sheet.spot({x_um, e.top_um}), 8);
    }
    for (int64_t y = first_line(e.bottom_um, mesh_um); y <= e.top_um; y += mesh_um) {
        const auto y_um = static_cast<int32_t>(y);
        layer.stroke(sheet.spot({e.left_um, y_um}), sheet.spot({e.right_um, y_um}), 8);
    }
    canvas.paint(layer, grid_colour);
}

void draw_points(Canvas &canvas, const Sheet &sheet, const std::vector<ale_point_t> &points)
{
    Layer layer = canvas.layer();
    for (const ale_point_t &p : points) {
        layer.disc(sheet.spot(p), 13);
    }
    canvas.paint(layer, point_colour, 110);
}

void draw_lines(Layer &layer, const Sheet &sheet, const ale_map_t &map, bool apart)
{
    for (int i = 0; i < map.line_count; i++) {
        if (is_apart(map.line[i]) == apart) {
            layer.stroke(sheet.spot(map.line[i].start), sheet.spot(map.line[i].end), 24);
        }
    }
}

void draw_walls(Canvas &canvas, const Sheet &sheet, const ale_map_t &map)
{
    if (has_walls_apart(map)) {
        Layer apart = canvas.layer();
        draw_lines(apart, sheet, map, true);
        canvas.paint(apart, apart_colour);
    }
    Layer layer = canvas.layer();
    draw_lines(layer, sheet, map, false);
    for (int i = 0; i < map.corner_count; i++) {
        layer.disc(sheet.spot(map.corner[i].p), 40);
    }
    canvas.paint(layer, wall_colour);
}

/* What is gone is thin, so that what stands there now shows. */
void draw_changes(Canvas &canvas, const Sheet &sheet, const MapScene &scene)
{
    for (const WallChange what : all_changes) {
        Layer layer = canvas.layer();
        for (const ChangedWall &change : scene.changes) {
            if (change.what == what) {
                layer.stroke(sheet.spot(change.start), sheet.spot(change.end),
                             what == WallChange::gone ? 18 : 44);
            }
        }
        canvas.paint(layer, change_colours[static_cast<size_t>(what)]);
    }
}

/* From the right end of the scale bar's row. */
void draw_change_legend(Canvas &canvas, const MapScene &scene)
{
    constexpr int32_t height = 15 * sub_pixels;
    constexpr int32_t apart = 2 * height;
    int32_t width = 0;
    for (const WallChange what : all_changes) {
        width += canvas.layer().text({0, 0}, change_label(scene, what), height, 16) + apart;
    }
    Spot at = {(canvas.width() - margin) * sub_pixels - width + apart,
               (canvas.height() - margin + 7) * sub_pixels};
    for (const WallChange what : all_changes) {
        Layer layer = canvas.layer();
        at.x += layer.text(at, change_label(scene, what), height, 16) + apart;
        canvas.paint(layer, change_colours[static_cast<size_t>(what)]);
    }
}

void draw_path(Canvas &canvas, const Sheet &sheet, const Trajectory &trajectory)
{
    Layer layer = canvas.layer();
    for (size_t i = 1; i < trajectory.size(); i++) {
        const ale_pose_t &from = trajectory[i - 1].pose;
        const ale_pose_t &to = trajectory[i].pose;
        layer.stroke(sheet.spot({from.x_um, from.y_um}), sheet.spot({to.x_um, to.y_um}), 14);
    }
    canvas.paint(layer, path_colour, 210);
}

/* A disc with a white rim and a nose that points ahead. */
void draw_robot(Canvas &canvas, const Sheet &sheet, const ale_pose_t &pose, Colour colour, int32_t radius)
{
    const Spot centre = sheet.spot({pose.x_um, pose.y_um});
    const int32_t nose = 2 * radius;
    const Spot ahead = {
        centre.x + static_cast<int32_t>(ale_round_shift(int64_t{nose} * ale_cos_q30(pose.theta_bam), 30)),
        centre.y - static_cast<int32_t>(ale_round_shift(int64_t{nose} * ale_sin_q30(pose.theta_bam), 30))};
    for (const bool rim : {true, false}) {
        Layer layer = canvas.layer();
        const int32_t wider = rim ? 32 : 0;
        layer.disc(centre, radius + wider);
        layer.stroke(centre, ahead, 40 + wider);
        canvas.paint(layer, rim ? white : colour);
    }
}

void draw_scale_bar(Canvas &canvas, const Sheet &sheet, int32_t bar_um)
{
    Layer layer = canvas.layer();
    const int32_t y = (canvas.height() - margin) * sub_pixels;
    const Spot left = {margin * sub_pixels, y};
    const Spot right = {left.x + sheet.length(bar_um), y};
    constexpr int32_t tick = 6 * sub_pixels;
    layer.stroke(left, right, 20);
    layer.stroke({left.x, y - tick}, {left.x, y + tick}, 20);
    layer.stroke({right.x, y - tick}, {right.x, y + tick}, 20);
    layer.text({right.x + 14 * sub_pixels, y + 7 * sub_pixels}, length_label(bar_um), 15 * sub_pixels, 16);
    canvas.paint(layer, ink);
}

} // namespace

void write_png(const std::string &path, const MapScene &scene)
{
    const Extent extent = picture_of(scene);
    const Sheet sheet(extent);
    const Scale scale = scale_of(sheet.extent());
    Canvas canvas(sheet.width(), sheet.height());
    draw_grid(canvas, sheet, scale.mesh_um);
    if (scene.draw_points && scene.cloud) {
        draw_points(canvas, sheet, points_in(extent, *scene.cloud));
    }
    draw_path(canvas, sheet, scene.trajectory);
    draw_walls(canvas, sheet, *scene.map);
    draw_changes(canvas, sheet, scene);
    if (!scene.trajectory.empty()) {
        draw_robot(canvas, sheet, scene.trajectory.front().pose, start_colour, start_radius);
        draw_robot(canvas, sheet, scene.trajectory.back().pose, path_colour, end_radius);
    }
    draw_scale_bar(canvas, sheet, scale.bar_um);
    if (!scene.changes.empty()) {
        draw_change_legend(canvas, scene);
    }
    canvas.write_png(path);
}

} // namespace ale
