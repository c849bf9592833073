#include "operator/console/recordings/thumbnail.h"

#include <algorithm>
#include <cmath>

namespace console
{

namespace
{

constexpr size_t most_walls = 120; /* of a thumbnail: more are not seen */
constexpr double thumbnail_side = 1000;

double length_of(const ale_map_line_t &line)
{
    return std::hypot(static_cast<double>(line.end.x_um) - line.start.x_um,
                      static_cast<double>(line.end.y_um) - line.start.y_um);
}

} // namespace

Thumbnail thumbnail_of(const ale_map_t &map)
{
    std::vector<const ale_map_line_t *> walls;
    for (size_t k = 0; k < map.line_count; k++) {
        walls.push_back(&map.line[k]);
    }
    std::sort(walls.begin(), walls.end(),
              [](const auto *a, const auto *b) { return length_of(*a) > length_of(*b); });
    walls.resize(std::min(walls.size(), most_walls));
    double left = INFINITY;
    double bottom = INFINITY;
    double side = 1;
    for (const auto *wall : walls) {
        left = std::min({left, static_cast<double>(wall->start.x_um), static_cast<double>(wall->end.x_um)});
        bottom =
            std::min({bottom, static_cast<double>(wall->start.y_um), static_cast<double>(wall->end.y_um)});
    }
    for (const auto *wall : walls) {
        side = std::max({side, wall->start.x_um - left, wall->end.x_um - left, wall->start.y_um - bottom,
                         wall->end.y_um - bottom});
    }
    Thumbnail drawing;
    const auto put = [&](double um) {
        drawing.push_back(static_cast<int>(std::lround(um / side * thumbnail_side)));
    };
    for (const auto *wall : walls) {
        for (const ale_point_t &end : {wall->start, wall->end}) {
            put(end.x_um - left);
            put(end.y_um - bottom);
        }
    }
    return drawing;
}

} // namespace console
