#include "graph/walls/building_axes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ale
{

namespace
{

constexpr double quarter = pi / 2;
constexpr double least_straight_m = 1.0; // of walls along the building that a node must see to say something
constexpr double least_agreement = 0.75; // of all that it sees
constexpr double along_rad = 0.14;       // so near to the building's directions: it, not a chair
constexpr double right_angled = 0.7;     // the same of all that was seen
constexpr double right_angled_followed = 0.8; // where the direction is followed: more, since it bends to them
constexpr size_t least_nodes = 10;            // before anything is concluded
constexpr double stray_rad = 0.0175;          // of what a scan shows of walls and furniture, one sigma
constexpr double shared_stray = 0.08;         // of its square: the same in all scans nearby
constexpr double line_stray_rad_m = 0.01;     // and of what a metre of them measures
// And so near where many scans are asked: a narrow gate about a heading that is off cuts what strays on one
// side only, and holds the heading where it is.
constexpr double along_all_rad = 0.26;
constexpr int refine_rounds = 3;
constexpr double followed_m = 3; // of walls a scan that move the direction followed half as far as they say
constexpr size_t run_nodes = 8;  // whose mean is looked at for drift
// How much worse views that match may fit when they are turned to the walls: in buildings at right angles
// they do by a tenth at the most where matches are poor, in bent ones by a tenth at the least. A match may
// miss by so much anyway (a Mahalanobis square) before its word is worth less.
constexpr double worst_excess = 0.08;
constexpr double clear_misfit = 1.5;
// Where nothing had drifted visibly little is to be won, and a slight bend tears views by little more.
constexpr double worst_excess_undrifted = 0.045;

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

bool is_right_angled(const Axes &axes)
{
    return axes.sum.norm() >= right_angled * axes.straight_m;
}

void add_walls(const Node &node, double heading, Witnesses witnesses, Axes *axes)
{
    each_wall(node, witnesses, [&](const WallSight &wall) {
        const double fourfold = 4 * (wall.direction + heading);
        axes->sum += wall.length_m * Eigen::Vector2d(cosine(fourfold), sine(fourfold));
        axes->straight_m += wall.length_m;
    });
}

int scans_of(const Node &node, Witnesses witnesses)
{
    return 1 + (witnesses == Witnesses::all_scans ? node.scans_after : 0);
}

Axes axes_of(const std::vector<Node> &nodes, const std::vector<Pose> &poses, Witnesses witnesses)
{
    Axes axes;
    for (size_t k = 0; k < nodes.size(); k++) {
        add_walls(nodes[k], poses[k].theta, witnesses, &axes);
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

// Nodes in a row whose walls agree best, and in what direction.
struct Run {
    size_t first;
    double direction;
};

Run clearest_run(const std::vector<Node> &nodes, const std::vector<Pose> &poses, Witnesses witnesses)
{
    Run clearest{0, 0};
    double most_m = 0;
    for (size_t first = 0; first < nodes.size(); first += run_nodes) {
        Axes run;
        for (size_t k = first; k < std::min(first + run_nodes, nodes.size()); k++) {
            add_walls(nodes[k], poses[k].theta, witnesses, &run);
        }
        if (run.sum.norm() > most_m) {
            most_m = run.sum.norm();
            clearest = {first, angle_of(run.sum) / 4};
        }
    }
    return clearest;
}

// The building's direction as it lies at every node, followed from where it is clearest to either end of the
// drive. Furniture at an angle, or a wing, is not followed.
std::vector<double> followed(const Run &clearest, const std::vector<Node> &nodes,
                             const std::vector<Pose> &poses, Witnesses witnesses)
{
    std::vector<double> directions(nodes.size());
    const auto hear = [&](size_t k, double direction) {
        const Opinion opinion = opinion_of(nodes[k], poses[k].theta, direction, witnesses);
        const double weight =
            opinion.along_m / (opinion.along_m + followed_m * scans_of(nodes[k], witnesses));
        return direction - weight * opinion.off;
    };
    double direction = clearest.direction;
    for (size_t k = std::min(clearest.first + run_nodes, nodes.size()); k-- > 0;) {
        direction = hear(k, direction);
        directions[k] = direction;
    }
    direction = directions[clearest.first];
    for (size_t k = clearest.first; k < nodes.size(); k++) {
        direction = hear(k, direction);
        directions[k] = direction;
    }
    return directions;
}

// Whether the walls agree with the directions at their nodes.
bool agree(const std::vector<double> &directions, const std::vector<Node> &nodes,
           const std::vector<Pose> &poses, Witnesses witnesses)
{
    double agreed_m = 0;
    double straight_m = 0;
    for (size_t k = 0; k < nodes.size(); k++) {
        Axes axes;
        add_walls(nodes[k], poses[k].theta, witnesses, &axes);
        const double fourfold = 4 * directions[k];
        agreed_m += axes.sum.dot(Eigen::Vector2d(cosine(fourfold), sine(fourfold)));
        straight_m += axes.straight_m;
    }
    return agreed_m >= right_angled_followed * straight_m;
}

// How far the mean of so many scans strays: what they share does not average out.
double stray2_of(int scans)
{
    return stray_rad * stray_rad * (shared_stray + (1 - shared_stray) / scans);
}

// What the walls suggest where the building's direction lies so at every node.
BuildingHeadings headings_by(double building, const std::vector<double> &directions,
                             const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                             Witnesses witnesses, bool robust)
{
    BuildingHeadings headings{building, {}};
    for (size_t k = 0; k < nodes.size(); k++) {
        const Opinion opinion = opinion_of(nodes[k], poses[k].theta, directions[k], witnesses);
        if (opinion.counts) {
            const double measured = line_stray_rad_m / opinion.along_m;
            headings.priors.push_back(
                {static_cast<int>(k), wrapped(poses[k].theta + opinion.off - directions[k]),
                 1 / (stray2_of(scans_of(nodes[k], witnesses)) + measured * measured), robust});
        }
    }
    return headings;
}

} // namespace

BuildingHeadings headings_by_walls(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                   Witnesses witnesses)
{
    if (nodes.size() < least_nodes) {
        return {};
    }
    const Axes axes = axes_of(nodes, poses, witnesses);
    if (is_right_angled(axes)) {
        const double building = refined(angle_of(axes.sum) / 4, nodes, poses, witnesses);
        return headings_by(building, std::vector<double>(nodes.size(), building), nodes, poses, witnesses,
                           true);
    }
    const std::vector<double> directions =
        followed(clearest_run(nodes, poses, witnesses), nodes, poses, witnesses);
    if (agree(directions, nodes, poses, witnesses)) {
        const double mean = std::accumulate(directions.begin(), directions.end(), 0.0) /
                            static_cast<double>(directions.size());
        return headings_by(mean, directions, nodes, poses, witnesses, false);
    }
    return {};
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

bool are_torn(double misfit_turned, double misfit_free, size_t matches, bool drifted)
{
    if (!drifted) {
        return misfit_turned - misfit_free > worst_excess_undrifted * misfit_free;
    }
    const double doubt = std::max(1.0, misfit_free / (clear_misfit * static_cast<double>(matches)));
    return misfit_turned - misfit_free > worst_excess * doubt * misfit_free;
}

} // namespace ale
