#include "graph/building_axes.h"

#include <cmath>

namespace ale
{

namespace
{

constexpr double quarter = pi / 2;
constexpr double least_straight_m = 1.0;  // of walls that a node must see to say something
constexpr double least_agreement = 0.75;  // of them, in one direction or across it
constexpr double right_angled = 0.7;      // the same of all that was seen
constexpr size_t least_nodes = 10;        // before anything is concluded
constexpr double stray_rad = 0.0175;      // of walls and furniture from the right angle, one sigma
constexpr double line_stray_rad_m = 0.01; // and of what a metre of them measures
constexpr size_t run_nodes = 8;           // whose mean is looked at for drift

// An angle but for quarter turns, -pi/4 .. pi/4.
double modulo_quarter(double angle)
{
    return angle - quarter * std::nearbyint(angle / quarter);
}

Eigen::Vector2d axes_of(const Node &node)
{
    return {node.axes_cos_m, node.axes_sin_m};
}

bool says_something(const Node &node)
{
    return node.straight_m >= least_straight_m && axes_of(node).norm() >= least_agreement * node.straight_m;
}

} // namespace

BuildingHeadings headings_by_walls(const std::vector<Node> &nodes, const std::vector<Pose> &poses)
{
    Eigen::Vector2d axes(0, 0);
    double straight_m = 0;
    size_t speaking = 0;
    for (size_t k = 0; k < nodes.size(); k++) {
        const Eigen::Matrix2d turn = rotation(4 * poses[k].theta);
        axes += turn * axes_of(nodes[k]);
        straight_m += nodes[k].straight_m;
        speaking += says_something(nodes[k]);
    }
    if (speaking < least_nodes || axes.norm() < right_angled * straight_m) {
        return {};
    }
    BuildingHeadings headings{angle_of(axes) / 4, {}};
    for (size_t k = 0; k < nodes.size(); k++) {
        if (says_something(nodes[k])) {
            const double seen = angle_of(axes_of(nodes[k])) / 4;
            const double off = modulo_quarter(headings.building - seen - poses[k].theta);
            const double measured = line_stray_rad_m / nodes[k].straight_m;
            headings.priors.push_back({static_cast<int>(k), wrapped(poses[k].theta + off - headings.building),
                                       1 / (stray_rad * stray_rad + measured * measured)});
        }
    }
    return headings;
}

bool have_drifted(const BuildingHeadings &headings, const std::vector<Pose> &poses)
{
    const std::vector<HeadingPrior> &priors = headings.priors;
    double sum = 0;
    for (size_t k = 0; k < priors.size(); k++) {
        const auto off = [&](size_t i) {
            return wrapped(headings.building + priors[i].theta -
                           poses[static_cast<size_t>(priors[i].pose)].theta);
        };
        sum += off(k);
        if (k >= run_nodes) {
            sum -= off(k - run_nodes);
        }
        if (k + 1 >= run_nodes && std::abs(sum) > run_nodes * stray_rad) {
            return true;
        }
    }
    return false;
}

} // namespace ale
