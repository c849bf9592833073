#include "common/export/map_image.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "base/fixed.h"
#include "common/export/map_tidy.h"

extern "C" {
#include "config/decimal.h"
}

namespace ale
{

namespace
{

struct Kind {
    const char *extension;
    void (*write)(const std::string &, const MapScene &);
};
constexpr std::array<Kind, 5> kinds = {{{".png", write_png},
                                        {".svg", write_svg},
                                        {".dxf", write_dxf},
                                        {".pgm", write_pgm},
                                        {".geojson", write_geojson}}};

const Kind *kind_of(const std::string &path)
{
    for (const Kind &kind : kinds) {
        const std::string extension = kind.extension;
        if (path.size() > extension.size() &&
            path.compare(path.size() - extension.size(), std::string::npos, extension) == 0) {
            return &kind;
        }
    }
    return nullptr;
}

Extent extent_without_points(const MapScene &scene)
{
    Extent extent = no_extent;
    for (int i = 0; i < scene.map->line_count; i++) {
        include(extent, scene.map->line[i].start);
        include(extent, scene.map->line[i].end);
    }
    for (const ChangedWall &change : scene.changes) {
        include(extent, change.start);
        include(extent, change.end);
    }
    for (const StampedPose &stamped : scene.trajectory) {
        include(extent, {stamped.pose.x_um, stamped.pose.y_um});
    }
    return extent;
}

int32_t moved(int32_t um, int32_t by_um)
{
    return static_cast<int32_t>(ale_clamp64(int64_t{um} + by_um, INT32_MIN, INT32_MAX));
}

/* A map of nothing, or of a single point, is drawn a metre wide: no picture has a side of length 0. */
Extent or_a_metre(const Extent &extent)
{
    constexpr int32_t half_um = 500000;
    if (extent.left_um > extent.right_um) {
        return {-half_um, -half_um, half_um, half_um};
    }
    const int64_t width_um = int64_t{extent.right_um} - extent.left_um;
    const int64_t height_um = int64_t{extent.top_um} - extent.bottom_um;
    if (std::max(width_um, height_um) >= 1000) {
        return extent;
    }
    return {moved(extent.left_um, -half_um), moved(extent.bottom_um, -half_um),
            moved(extent.right_um, half_um), moved(extent.top_um, half_um)};
}

/* All points but the outermost of each side; left and right, bottom and top by themselves. */
void include_most(Extent &extent, const std::vector<ale_point_t> &points)
{
    const size_t left_out = points.size() / 200;
    std::vector<int32_t> x;
    std::vector<int32_t> y;
    for (const ale_point_t &p : points) {
        x.push_back(p.x_um);
        y.push_back(p.y_um);
    }
    std::sort(x.begin(), x.end());
    std::sort(y.begin(), y.end());
    include(extent, {x[left_out], y[left_out]});
    include(extent, {x[x.size() - 1 - left_out], y[y.size() - 1 - left_out]});
}

} // namespace

bool has_walls_apart(const ale_map_t &map)
{
    return std::any_of(map.line, map.line + map.line_count, is_apart);
}

bool is_map_image_name(const std::string &path)
{
    return kind_of(path) != nullptr;
}

void write_map_image(const std::string &path, const MapScene &scene)
{
    const Kind *kind = kind_of(path);
    if (!kind) {
        throw std::runtime_error(path + ": the name must end in .svg, .png, .pgm or .dxf");
    }
    const auto tidy = std::make_unique<ale_map_t>(*scene.map);
    ale_map_tidy(tidy.get());
    MapScene shown = scene;
    shown.map = tidy.get();
    kind->write(path, shown);
}

Extent extent_of(const MapScene &scene)
{
    Extent extent = extent_without_points(scene);
    if (scene.draw_points && scene.cloud && !scene.cloud->empty()) {
        include(extent, {scene.cloud->extent().left_um, scene.cloud->extent().bottom_um});
        include(extent, {scene.cloud->extent().right_um, scene.cloud->extent().top_um});
    }
    return or_a_metre(extent);
}

Extent picture_of(const MapScene &scene)
{
    Extent extent = extent_without_points(scene);
    if (scene.draw_points && scene.cloud && !scene.cloud->points().empty()) {
        include_most(extent, scene.cloud->points());
    }
    return or_a_metre(extent);
}

std::vector<ale_point_t> points_in(const Extent &extent, const ScanCloud &cloud)
{
    std::vector<ale_point_t> inside;
    std::copy_if(cloud.points().begin(), cloud.points().end(), std::back_inserter(inside),
                 [&](const ale_point_t &p) {
                     return p.x_um >= extent.left_um && p.x_um <= extent.right_um &&
                            p.y_um >= extent.bottom_um && p.y_um <= extent.top_um;
                 });
    return inside;
}

Scale scale_of(const Extent &extent)
{
    const int64_t width_um = int64_t{extent.right_um} - extent.left_um;
    const int64_t height_um = int64_t{extent.top_um} - extent.bottom_um;
    const int64_t size_um = std::max(width_um, height_um);
    Scale scale = {500000, 500000};
    for (const int32_t step_um : {1000000, 2000000, 5000000, 10000000, 20000000, 50000000, 100000000}) {
        if (int64_t{step_um} * 5 <= size_um) {
            scale.bar_um = step_um;
        }
        if (int64_t{step_um} * 10 <= size_um) {
            scale.mesh_um = step_um;
        }
    }
    return scale;
}

std::string length_label(int32_t length_um)
{
    char text[ALE_DECIMAL_TEXT];
    ale_decimal_print(length_um, 6, text);
    return std::string(text) + " m";
}

int64_t changed_um(const std::vector<ChangedWall> &changes, WallChange what)
{
    int64_t sum_um = 0;
    for (const ChangedWall &change : changes) {
        const int64_t dx = int64_t{change.end.x_um} - change.start.x_um;
        const int64_t dy = int64_t{change.end.y_um} - change.start.y_um;
        const auto length_um = static_cast<int64_t>(ale_isqrt(static_cast<uint64_t>(dx * dx + dy * dy)));
        sum_um += change.what == what ? ale_round_div(length_um, 1000) * 1000 : 0;
    }
    return sum_um;
}

std::string change_label(const MapScene &scene, WallChange what)
{
    constexpr std::array<const char *, 3> words = {"new ", "moved ", "gone "};
    constexpr int64_t tenth_um = 100000;
    const int64_t um = ale_round_div(changed_um(scene.changes, what), tenth_um) * tenth_um;
    return words[static_cast<size_t>(what)] +
           length_label(static_cast<int32_t>(std::min<int64_t>(um, INT32_MAX)));
}

} // namespace ale
