#include "lab/explore/score.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace explore
{

namespace
{

constexpr double step = 0.025;
constexpr double near_a_wall = 0.1;

/* The plan as a raster of distances to the nearest wall. */
class Plan
{
  public:
    explicit Plan(const sim::World &world, double farthest) : left_(1e9), bottom_(1e9)
    {
        double right = -1e9;
        double top = -1e9;
        for (const sim::Wall &wall : world.walls) {
            left_ = std::min({left_, wall.a.x, wall.b.x});
            right = std::max({right, wall.a.x, wall.b.x});
            bottom_ = std::min({bottom_, wall.a.y, wall.b.y});
            top = std::max({top, wall.a.y, wall.b.y});
        }
        columns = static_cast<int>((right - left_) / step) + 1;
        rows = static_cast<int>((top - bottom_) / step) + 1;
        distance_.assign(static_cast<size_t>(columns) * static_cast<size_t>(rows), farthest);
        for (const sim::Wall &wall : world.walls) {
            draw(wall, farthest);
        }
    }

    sim::Point place(int column, int row) const
    {
        return {left_ + (column + 0.5) * step, bottom_ + (row + 0.5) * step};
    }
    int column_of(double x) const
    {
        return static_cast<int>(std::floor((x - left_) / step));
    }
    int row_of(double y) const
    {
        return static_cast<int>(std::floor((y - bottom_) / step));
    }
    size_t index(int column, int row) const
    {
        return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
    }
    double to_wall(int column, int row) const
    {
        return distance_[index(column, row)];
    }

    int columns;
    int rows;

  private:
    void draw(const sim::Wall &wall, double farthest)
    {
        const int first_column = std::max(0, column_of(std::min(wall.a.x, wall.b.x) - farthest));
        const int last_column = std::min(columns - 1, column_of(std::max(wall.a.x, wall.b.x) + farthest));
        const int first_row = std::max(0, row_of(std::min(wall.a.y, wall.b.y) - farthest));
        const int last_row = std::min(rows - 1, row_of(std::max(wall.a.y, wall.b.y) + farthest));
        for (int row = first_row; row <= last_row; row++) {
            for (int column = first_column; column <= last_column; column++) {
                double &distance = distance_[index(column, row)];
                distance = std::min(distance, sim::distance_to_wall(place(column, row), wall));
            }
        }
    }

    double left_;
    double bottom_;
    std::vector<double> distance_;
};

/* Where the centre of the disc may be. */
std::vector<uint8_t> flood(const Plan &plan, sim::Point start, double radius)
{
    std::vector<uint8_t> reached(static_cast<size_t>(plan.columns) * static_cast<size_t>(plan.rows), 0);
    std::vector<std::pair<int, int>> open;
    const auto enter = [&](int column, int row) {
        if (column < 0 || row < 0 || column >= plan.columns || row >= plan.rows) {
            return;
        }
        uint8_t &here = reached[plan.index(column, row)];
        if (here == 0 && plan.to_wall(column, row) > radius) {
            here = 1;
            open.emplace_back(column, row);
        }
    };
    enter(plan.column_of(start.x), plan.row_of(start.y));
    while (!open.empty()) {
        const auto [column, row] = open.back();
        open.pop_back();
        enter(column - 1, row);
        enter(column + 1, row);
        enter(column, row - 1);
        enter(column, row + 1);
    }
    return reached;
}

/* What the disc sweeps from there: its centre keeps the radius from the border of the plan. Only the rim of
 * what was reached has to be widened. */
std::vector<uint8_t> swept(const Plan &plan, const std::vector<uint8_t> &reached, double radius)
{
    std::vector<uint8_t> area = reached;
    const int reach = static_cast<int>(radius / step + 0.001); /* 0.2 / 0.025 is a little below 8 */
    const auto is_rim = [&](int column, int row) {
        return reached[plan.index(column - 1, row)] == 0 || reached[plan.index(column + 1, row)] == 0 ||
               reached[plan.index(column, row - 1)] == 0 || reached[plan.index(column, row + 1)] == 0;
    };
    for (int row = reach; row < plan.rows - reach; row++) {
        for (int column = reach; column < plan.columns - reach; column++) {
            if (reached[plan.index(column, row)] == 0 || !is_rim(column, row)) {
                continue;
            }
            for (int dy = -reach; dy <= reach; dy++) {
                for (int dx = -reach; dx <= reach; dx++) {
                    if (dx * dx + dy * dy <= reach * reach) {
                        area[plan.index(column + dx, row + dy)] = 1;
                    }
                }
            }
        }
    }
    return area;
}

sim::Point seen_from(const sim::Pose &start, sim::Point p)
{
    const double c = std::cos(start.theta);
    const double s = std::sin(start.theta);
    const double dx = p.x - start.x;
    const double dy = p.y - start.y;
    return {c * dx + s * dy, c * dy - s * dx};
}

} // namespace

Score score(const sim::World &world, double robot_width, const std::function<Place(sim::Point)> &asked)
{
    const double radius = robot_width / 2;
    const Plan plan(world, radius + step);
    const std::vector<uint8_t> area =
        swept(plan, flood(plan, {world.start.x, world.start.y}, radius), radius);
    double all = 0;
    double mapped = 0;
    double wrong = 0;
    for (int row = 0; row < plan.rows; row++) {
        for (int column = 0; column < plan.columns; column++) {
            if (area[plan.index(column, row)] != 0) {
                const Place said = asked(seen_from(world.start, plan.place(column, row)));
                all++;
                mapped += said != Place::unseen ? 1 : 0;
                wrong += said == Place::occupied && plan.to_wall(column, row) > near_a_wall ? 1 : 0;
            }
        }
    }
    return {all * step * step, all > 0 ? mapped / all : 0, all > 0 ? wrong / all : 0};
}

} // namespace explore
