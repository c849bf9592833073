#include <algorithm>
#include <array>

#include "common/export/map_image.h"

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

/* Size for those who ask for one: without it a viewer takes the metres for pixels. */
constexpr int64_t long_side_px = 1600;

/* SVG's y points down: all y are negated as they are written. Millimetres are enough for print. */
class SvgFile
{
  public:
    explicit SvgFile(const std::string &path) : file_(path)
    {
    }
    SvgFile &put(std::string_view text)
    {
        file_.put(text);
        return *this;
    }
    SvgFile &put_pixels(int64_t px)
    {
        file_.put_integer(px);
        return *this;
    }
    SvgFile &put_length(int64_t um)
    {
        file_.put_decimal(ale_round_div(um, 1000), 3);
        return *this;
    }
    SvgFile &put_point(const char *command, const ale_point_t &p)
    {
        return put(command).put_length(p.x_um).put(" ").put_length(-int64_t{p.y_um});
    }
    void close()
    {
        file_.close();
    }

  private:
    TextFile file_;
};

/* Strokes are as wide as suits a map of this size. */
struct Style {
    int64_t margin_um;
    int64_t stroke_um;
    Scale scale;
};

Style style_of(const Extent &e)
{
    const int64_t size_um = std::max(int64_t{e.right_um} - e.left_um, int64_t{e.top_um} - e.bottom_um);
    return {size_um / 25, std::max<int64_t>(size_um / 700, 1000), scale_of(e)};
}

void put_head(SvgFile &svg, const Extent &e, const Style &style)
{
    const int64_t left_um = e.left_um - style.margin_um;
    const int64_t top_um = -int64_t{e.top_um} - style.margin_um;
    const int64_t width_um = int64_t{e.right_um} - e.left_um + 2 * style.margin_um;
    const int64_t height_um = int64_t{e.top_um} - e.bottom_um + 4 * style.margin_um;
    const int64_t longest_um = std::max(width_um, height_um);
    svg.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"");
    svg.put_pixels(width_um * long_side_px / longest_um).put("\" height=\"");
    svg.put_pixels(height_um * long_side_px / longest_um).put("\" viewBox=\"");
    svg.put_length(left_um).put(" ").put_length(top_um).put(" ").put_length(width_um).put(" ");
    svg.put_length(height_um)
        .put("\">\n<!-- metres; y of the map is -y here -->\n<rect x=\"")
        .put_length(left_um);
    svg.put("\" y=\"").put_length(top_um).put("\" width=\"").put_length(width_um).put("\" height=\"");
    svg.put_length(height_um).put("\" fill=\"#fff\"/>\n");
}

/* Opens a group of strokes, `tenths` of the usual width wide. */
void begin_strokes(SvgFile &svg, const char *id, const char *colour, int64_t width_um, const char *more = "")
{
    svg.put("<g id=\"").put(id).put("\" fill=\"none\" stroke=\"").put(colour).put("\" stroke-width=\"");
    svg.put_length(width_um)
        .put("\" stroke-linecap=\"round\" stroke-linejoin=\"round\"")
        .put(more)
        .put(">\n");
}

void put_grid(SvgFile &svg, const Extent &e, const Style &style)
{
    const int64_t mesh_um = style.scale.mesh_um;
    begin_strokes(svg, "grid", "#e4e8ee", style.stroke_um / 2);
    svg.put("<path d=\"");
    for (int64_t x = e.left_um / mesh_um * mesh_um; x <= e.right_um; x += mesh_um) {
        svg.put_point("M", {static_cast<int32_t>(x), e.bottom_um}).put("V").put_length(-int64_t{e.top_um});
    }
    for (int64_t y = e.bottom_um / mesh_um * mesh_um; y <= e.top_um; y += mesh_um) {
        svg.put_point("M", {e.left_um, static_cast<int32_t>(y)}).put("H").put_length(e.right_um);
    }
    svg.put("\"/>\n</g>\n");
}

void put_points(SvgFile &svg, const std::vector<ale_point_t> &points, const Style &style)
{
    begin_strokes(svg, "points", "#5c80a8", style.stroke_um, " stroke-opacity=\"0.45\"");
    svg.put("<path d=\"");
    for (const ale_point_t &p : points) {
        svg.put_point("M", p).put("h0");
    }
    svg.put("\"/>\n</g>\n");
}

void put_path(SvgFile &svg, const Trajectory &trajectory, const Style &style)
{
    begin_strokes(svg, "trajectory", "#de5230", style.stroke_um, " stroke-opacity=\"0.85\"");
    svg.put("<path d=\"");
    for (size_t i = 0; i < trajectory.size(); i++) {
        svg.put_point(i ? "L" : "M", {trajectory[i].pose.x_um, trajectory[i].pose.y_um});
    }
    svg.put("\"/>\n</g>\n");
}

constexpr char apart_colour[] = "#8654cd";

void put_lines(SvgFile &svg, const ale_map_t &map, bool apart)
{
    for (int i = 0; i < map.line_count; i++) {
        if (is_apart(map.line[i]) == apart) {
            svg.put("<path d=\"").put_point("M", map.line[i].start);
            svg.put_point("L", map.line[i].end).put("\"/>\n");
        }
    }
    svg.put("</g>\n");
}

void put_walls(SvgFile &svg, const ale_map_t &map, const Style &style)
{
    if (has_walls_apart(map)) {
        begin_strokes(svg, "apart", apart_colour, 2 * style.stroke_um);
        put_lines(svg, map, true);
    }
    begin_strokes(svg, "walls", "#181f2e", 2 * style.stroke_um);
    put_lines(svg, map, false);
    begin_strokes(svg, "corners", "#181f2e", 4 * style.stroke_um);
    for (int i = 0; i < map.corner_count; i++) {
        svg.put_point("<path d=\"M", map.corner[i].p).put("h0\"/>\n");
    }
    svg.put("</g>\n");
}

constexpr std::array<const char *, 3> change_ids = {"added", "moved", "gone"};
constexpr std::array<const char *, 3> change_colours = {"#269654", "#f09214", "#d63031"};

/* What is gone is thin, so that what stands there now shows. */
void put_changes(SvgFile &svg, const MapScene &scene, const Style &style)
{
    for (const WallChange what : all_changes) {
        const auto k = static_cast<size_t>(what);
        begin_strokes(svg, change_ids[k], change_colours[k],
                      what == WallChange::gone ? style.stroke_um : 3 * style.stroke_um);
        for (const ChangedWall &change : scene.changes) {
            if (change.what == what) {
                svg.put_point("<path d=\"M", change.start).put_point("L", change.end).put("\"/>\n");
            }
        }
        svg.put("</g>\n");
    }
}

void put_robot(SvgFile &svg, const char *id, const char *colour, const ale_pose_t &pose, int64_t radius_um,
               const Style &style)
{
    const ale_point_t nose = ale_pose_apply(pose, {static_cast<int32_t>(2 * radius_um), 0});
    const ale_point_t centre = {pose.x_um, pose.y_um};
    svg.put("<g id=\"").put(id).put("\"><circle cx=\"").put_length(centre.x_um).put("\" cy=\"");
    svg.put_length(-int64_t{centre.y_um}).put("\" r=\"").put_length(radius_um).put("\" fill=\"").put(colour);
    svg.put("\"/><path d=\"").put_point("M", centre).put_point("L", nose).put("\" stroke=\"").put(colour);
    svg.put("\" stroke-width=\"").put_length(4 * style.stroke_um).put("\" stroke-linecap=\"round\"/></g>\n");
}

void put_scale_bar(SvgFile &svg, const Extent &e, const Style &style)
{
    const int64_t y_um = -int64_t{e.bottom_um} + 2 * style.margin_um;
    const int64_t tick_um = style.margin_um / 4;
    begin_strokes(svg, "scale", "#5a6270", 3 * style.stroke_um / 2);
    svg.put("<path d=\"M")
        .put_length(e.left_um)
        .put(" ")
        .put_length(y_um - tick_um)
        .put("v")
        .put_length(2 * tick_um);
    svg.put("m0 ")
        .put_length(-tick_um)
        .put("h")
        .put_length(style.scale.bar_um)
        .put("m0 ")
        .put_length(-tick_um);
    svg.put("v").put_length(2 * tick_um).put("\"/>\n</g>\n<text x=\"");
    svg.put_length(int64_t{e.left_um} + style.scale.bar_um + style.margin_um / 2).put("\" y=\"");
    svg.put_length(y_um + tick_um).put("\" font-family=\"sans-serif\" fill=\"#5a6270\" font-size=\"");
    svg.put_length(style.margin_um * 3 / 4).put("\">").put(length_label(style.scale.bar_um)).put("</text>\n");
}

/* At the right end of the scale bar's row. */
void put_legend(SvgFile &svg, const Extent &e, const Style &style)
{
    const int64_t y_um = -int64_t{e.bottom_um} + 2 * style.margin_um + style.margin_um / 4;
    svg.put("<text text-anchor=\"end\" x=\"").put_length(e.right_um).put("\" y=\"").put_length(y_um);
    svg.put("\" font-family=\"sans-serif\" fill=\"").put(apart_colour).put("\" font-size=\"");
    svg.put_length(style.margin_um * 3 / 4).put("\">not joined</text>\n");
}

void put_change_legend(SvgFile &svg, const Extent &e, const Style &style, const MapScene &scene)
{
    const int64_t y_um = -int64_t{e.bottom_um} + 2 * style.margin_um + style.margin_um / 4;
    svg.put("<text text-anchor=\"end\" x=\"").put_length(e.right_um).put("\" y=\"").put_length(y_um);
    svg.put("\" font-family=\"sans-serif\" font-size=\"").put_length(style.margin_um * 3 / 4).put("\">");
    for (const WallChange what : all_changes) {
        svg.put(" <tspan fill=\"").put(change_colours[static_cast<size_t>(what)]).put("\">");
        svg.put(change_label(scene, what)).put("</tspan>");
    }
    svg.put("</text>\n");
}

} // namespace

void write_svg(const std::string &path, const MapScene &scene)
{
    const Extent extent = picture_of(scene);
    const Style style = style_of(extent);
    SvgFile svg(path);
    put_head(svg, extent, style);
    put_grid(svg, extent, style);
    if (scene.draw_points && scene.cloud) {
        put_points(svg, points_in(extent, *scene.cloud), style);
    }
    put_path(svg, scene.trajectory, style);
    put_walls(svg, *scene.map, style);
    if (!scene.changes.empty()) {
        put_changes(svg, scene, style);
    }
    if (!scene.trajectory.empty()) {
        put_robot(svg, "start", "#269654", scene.trajectory.front().pose, 7 * style.stroke_um, style);
        put_robot(svg, "end", "#de5230", scene.trajectory.back().pose, 5 * style.stroke_um, style);
    }
    put_scale_bar(svg, extent, style);
    if (has_walls_apart(*scene.map)) {
        put_legend(svg, extent, style);
    }
    if (!scene.changes.empty()) {
        put_change_legend(svg, extent, style, scene);
    }
    svg.put("</svg>\n").close();
}

} // namespace ale
