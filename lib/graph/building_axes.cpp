#include "graph/building_axes.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

constexpr double quarter = pi / 2;
constexpr double least_straight_m = 1.0;  // of walls along the building that a node must see to say something
constexpr double least_agreement = 0.75;  // of all that it sees
constexpr double along_rad = 0.14;        // so near to the building's directions: it, not a chair
constexpr double right_angled = 0.7;      // the same of all that was seen
constexpr size_t least_nodes = 10;        // before anything is concluded
constexpr double stray_rad = 0.0175;      // of what a scan shows of walls and furniture, one sigma
constexpr double shared_stray = 0.08;     // of its square: the same in all scans nearby
constexpr double line_stray_rad_m = 0.01; // and of what a metre of them measures
// And so near where many scans are asked: a narrow gate about a heading that is off cuts what strays on one
// side only, and holds the heading where it is.
constexpr double along_all_rad = 0.26;
constexpr int refine_rounds = 3;
constexpr size_t run_nodes = 8; // whose mean is looked at for drift

// An angle but for quarter turns, -pi/4 .. pi/4.
double modulo_quarter(double angle)
{
    return angle - quarter * std::nearbyint(angle / quarter);
}

template <class See> void each_wall(const Node &node, Witnesses witnesses, const See &see)
{
    std::for_each(node.walls.begin(), node.walls.end(), see);
    if (witnesses == Witnesses::all_scans) {
        std::for_each(node.walls_after.begin(), node.walls_after.end(), see);
    }
}

// Unit vectors of four times the direction, by length: directions that are quarter turns apart fall together.
struct Axes {
    Eigen::Vector2d sum{0, 0};
    double straight_m = 0;
};

Axes axes_of(const std::vector<Node> &nodes, const std::vector<Pose> &poses, Witnesses witnesses)
{
    Axes axes;
    for (size_t k = 0; k < nodes.size(); k++) {
        each_wall(nodes[k], witnesses, [&](const WallSight &wall) {
            const double fourfold = 4 * (wall.direction + poses[k].theta);
            axes.sum += wall.length_m * Eigen::Vector2d(cosine(fourfold), sine(fourfold));
            axes.straight_m += wall.length_m;
        });
    }
    return axes;
}

// How far a node's heading is off, by the walls along the building's directions that it sees; and how much of
// them.
struct Opinion {
    double off;
    double along_m;
    bool counts;
};

Opinion opinion_of(const Node &node, double heading, double building, Witnesses witnesses)
{
    const double gate = witnesses == Witnesses::all_scans ? along_all_rad : along_rad;
    double sum = 0;
    double along_m = 0;
    double all_m = 0;
    each_wall(node, witnesses, [&](const WallSight &wall) {
        const double off = modulo_quarter(building - wall.direction - heading);
        all_m += wall.length_m;
        if (std::abs(off) < gate) {
            sum += wall.length_m * off;
            along_m += wall.length_m;
        }
    });
    const bool counts = along_m >= least_straight_m && along_m >= least_agreement * all_m;
    return {counts ? sum / along_m : 0, along_m, counts};
}

// The direction that most walls share: furniture at an angle pulls the mean of all, but not that of those
// near it.
double refined(double building, const std::vector<Node> &nodes, const std::vector<Pose> &poses,
               Witnesses witnesses)
{
    for (int round = 0; round < refine_rounds; round++) {
        double sum = 0;
        double along_m = 0;
        for (size_t k = 0; k < nodes.size(); k++) {
            const Opinion opinion = opinion_of(nodes[k], poses[k].theta, building, witnesses);
            sum += opinion.along_m * opinion.off;
            along_m += opinion.counts ? opinion.along_m : 0;
        }
        building -= along_m > 0 ? sum / along_m : 0;
    }
    return building;
}

// How far the mean of so many scans strays: what they share does not average out.
double stray2_of(int scans)
{
    return stray_rad * stray_rad * (shared_stray + (1 - shared_stray) / scans);
}

} // namespace

BuildingHeadings headings_by_walls(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                   Witnesses witnesses)
{
    const Axes axes = axes_of(nodes, poses, witnesses);
    if (nodes.size() < least_nodes || axes.sum.norm() < right_angled * axes.straight_m) {
        return {};
    }
    BuildingHeadings headings{refined(angle_of(axes.sum) / 4, nodes, poses, witnesses), {}};
    for (size_t k = 0; k < nodes.size(); k++) {
        const Opinion opinion = opinion_of(nodes[k], poses[k].theta, headings.building, witnesses);
        if (opinion.counts) {
            const double measured = line_stray_rad_m / opinion.along_m;
            const int scans = 1 + (witnesses == Witnesses::all_scans ? nodes[k].scans_after : 0);
            headings.priors.push_back({static_cast<int>(k),
                                       wrapped(poses[k].theta + opinion.off - headings.building),
                                       1 / (stray2_of(scans) + measured * measured)});
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
