#include "graph/walls/building_direction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ale
{

namespace
{

constexpr double quarter = pi / 2;
constexpr double least_aligned_m = 1.0; // wall along the building that a node must see to measure its heading
constexpr double least_agreement = 0.75;   // aligned part of all walls that it sees
constexpr double gate_rad = 0.14;          // a line farther off the building's directions is furniture
constexpr double right_angled = 0.7;       // least agreement of all walls of a drive with one direction
constexpr double right_angled_local = 0.8; // with a direction tracked along the drive, which adapts to them
constexpr size_t least_nodes = 10;
constexpr double wall_sigma_rad = 0.0175; // spread of wall directions, one sigma
constexpr double common_variance = 0.08;  // part of its square that all scans nearby share
constexpr double line_sigma_rad_m = 0.01; // error of the direction of one metre of line
// Gate when many scans count: a narrow one about a wrong heading cuts off one side of the spread only, and
// keeps the heading wrong.
constexpr double gate_all_scans_rad = 0.26;
constexpr int refine_rounds = 3;
constexpr double inertia_m = 3; // metres of wall a scan that move the tracked direction half way
constexpr size_t run_nodes = 8; // whose mean is tested for drift
// How much worse scan matches may fit with the constraint than without it. In right-angled buildings they fit
// at most a tenth worse, in bent ones at least a tenth. A match may miss by clear_misfit (squared
// Mahalanobis) before it counts for less.
constexpr double worst_excess = 0.08;
constexpr double clear_misfit = 1.5;
// Without visible drift there is little to gain, and a slight bend worsens the fit by little more than this.
constexpr double worst_excess_undrifted = 0.045;

// An angle modulo quarter turns, -pi/4 .. pi/4.
double modulo_quarter(double angle)
{
    return angle - quarter * std::nearbyint(angle / quarter);
}

bool counts(const Node &node, const WallChoice &choice)
{
    return !choice.map_id || *choice.map_id == node.map_id;
}

template <class Visit> void each_wall(const Node &node, const WallChoice &choice, const Visit &visit)
{
    if (!counts(node, choice)) {
        return;
    }
    std::for_each(node.walls.begin(), node.walls.end(), visit);
    if (choice.source == WallSource::all_scans) {
        std::for_each(node.later_walls.begin(), node.later_walls.end(), visit);
    }
}

// Unit vectors of four times the direction, weighted by length: directions a quarter turn apart coincide.
struct FourfoldSum {
    Eigen::Vector2d sum{0, 0};
    double length_m = 0;
};

bool is_right_angled(const FourfoldSum &walls)
{
    return walls.sum.norm() >= right_angled * walls.length_m;
}

void add_walls(const Node &node, double heading, const WallChoice &choice, FourfoldSum *walls)
{
    each_wall(node, choice, [&](const WallDirection &wall) {
        const double fourfold = 4 * (wall.direction_rad + heading);
        walls->sum += wall.length_m * Eigen::Vector2d(cosine(fourfold), sine(fourfold));
        walls->length_m += wall.length_m;
    });
}

int scans_of(const Node &node, const WallChoice &choice)
{
    return 1 + (choice.source == WallSource::all_scans ? node.later_scans : 0);
}

FourfoldSum sum_of(const std::vector<Node> &nodes, const std::vector<Pose> &poses, const WallChoice &choice)
{
    FourfoldSum sum;
    for (size_t k = 0; k < nodes.size(); k++) {
        add_walls(nodes[k], poses[k].theta, choice, &sum);
    }
    return sum;
}

// Error of a node's heading by the aligned walls that it sees, and their length.
struct HeadingError {
    double mean_rad;
    double aligned_m;
    bool is_valid;
};

HeadingError heading_error_of(const Node &node, double heading, double building, const WallChoice &choice)
{
    const double gate = choice.source == WallSource::all_scans ? gate_all_scans_rad : gate_rad;
    double sum = 0;
    double aligned_m = 0;
    double all_m = 0;
    each_wall(node, choice, [&](const WallDirection &wall) {
        const double off = modulo_quarter(building - wall.direction_rad - heading);
        all_m += wall.length_m;
        if (std::abs(off) < gate) {
            sum += wall.length_m * off;
            aligned_m += wall.length_m;
        }
    });
    const bool is_valid = aligned_m >= least_aligned_m && aligned_m >= least_agreement * all_m;
    return {is_valid ? sum / aligned_m : 0, aligned_m, is_valid};
}

// Refines the direction by the aligned walls alone, so that furniture at an angle has no effect.
double refined(double building, const std::vector<Node> &nodes, const std::vector<Pose> &poses,
               const WallChoice &choice)
{
    for (int round = 0; round < refine_rounds; round++) {
        double sum = 0;
        double aligned_m = 0;
        for (size_t k = 0; k < nodes.size(); k++) {
            const HeadingError error = heading_error_of(nodes[k], poses[k].theta, building, choice);
            sum += error.aligned_m * error.mean_rad;
            aligned_m += error.is_valid ? error.aligned_m : 0;
        }
        building -= aligned_m > 0 ? sum / aligned_m : 0;
    }
    return building;
}

// The nodes in a row whose walls agree best, and their direction.
struct Run {
    size_t first;
    double direction_rad;
};

Run clearest_run(const std::vector<Node> &nodes, const std::vector<Pose> &poses, const WallChoice &choice)
{
    Run clearest{0, 0};
    double most_m = 0;
    for (size_t first = 0; first < nodes.size(); first += run_nodes) {
        FourfoldSum run;
        for (size_t k = first; k < std::min(first + run_nodes, nodes.size()); k++) {
            add_walls(nodes[k], poses[k].theta, choice, &run);
        }
        if (run.sum.norm() > most_m) {
            most_m = run.sum.norm();
            clearest = {first, angle_of(run.sum) / 4};
        }
    }
    return clearest;
}

// The building's direction as seen at every node, tracked from the clearest run to both ends of the drive.
// Furniture or a wing at an angle does not move it.
std::vector<double> tracked_directions(const Run &clearest, const std::vector<Node> &nodes,
                                       const std::vector<Pose> &poses, const WallChoice &choice)
{
    std::vector<double> directions(nodes.size());
    const auto update = [&](size_t k, double direction) {
        const HeadingError error = heading_error_of(nodes[k], poses[k].theta, direction, choice);
        const double weight = error.aligned_m / (error.aligned_m + inertia_m * scans_of(nodes[k], choice));
        return direction - weight * error.mean_rad;
    };
    double direction = clearest.direction_rad;
    for (size_t k = std::min(clearest.first + run_nodes, nodes.size()); k-- > 0;) {
        direction = update(k, direction);
        directions[k] = direction;
    }
    direction = directions[clearest.first];
    for (size_t k = clearest.first; k < nodes.size(); k++) {
        direction = update(k, direction);
        directions[k] = direction;
    }
    return directions;
}

// Whether the walls agree with the directions at their nodes.
bool walls_agree(const std::vector<double> &directions, const std::vector<Node> &nodes,
                 const std::vector<Pose> &poses, const WallChoice &choice)
{
    double agreed_m = 0;
    double length_m = 0;
    for (size_t k = 0; k < nodes.size(); k++) {
        FourfoldSum walls;
        add_walls(nodes[k], poses[k].theta, choice, &walls);
        const double fourfold = 4 * directions[k];
        agreed_m += walls.sum.dot(Eigen::Vector2d(cosine(fourfold), sine(fourfold)));
        length_m += walls.length_m;
    }
    return agreed_m >= right_angled_local * length_m;
}

// Variance of the mean direction of so many scans: the common part does not average out.
double variance_of(int scans)
{
    return wall_sigma_rad * wall_sigma_rad * (common_variance + (1 - common_variance) / scans);
}

// The constraint, given the building's direction as seen at every node.
BuildingConstraint constraint_by(double building, const std::vector<double> &directions,
                                 const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                 const WallChoice &choice, bool robust)
{
    BuildingConstraint constraint{building, {}};
    for (size_t k = 0; k < nodes.size(); k++) {
        const HeadingError error = heading_error_of(nodes[k], poses[k].theta, directions[k], choice);
        if (error.is_valid) {
            const double measured = line_sigma_rad_m / error.aligned_m;
            constraint.priors.push_back(
                {static_cast<int>(k), wrapped(poses[k].theta + error.mean_rad - directions[k]),
                 1 / (variance_of(scans_of(nodes[k], choice)) + measured * measured), robust});
        }
    }
    return constraint;
}

} // namespace

BuildingConstraint building_constraint_from_walls(const std::vector<Node> &nodes,
                                                  const std::vector<Pose> &poses, const WallChoice &choice)
{
    const auto counted =
        std::count_if(nodes.begin(), nodes.end(), [&](const Node &node) { return counts(node, choice); });
    if (static_cast<size_t>(counted) < least_nodes) {
        return {};
    }
    const FourfoldSum walls = sum_of(nodes, poses, choice);
    if (is_right_angled(walls)) {
        const double building = refined(angle_of(walls.sum) / 4, nodes, poses, choice);
        return constraint_by(building, std::vector<double>(nodes.size(), building), nodes, poses, choice,
                             true);
    }
    const std::vector<double> directions =
        tracked_directions(clearest_run(nodes, poses, choice), nodes, poses, choice);
    if (walls_agree(directions, nodes, poses, choice)) {
        const double mean = std::accumulate(directions.begin(), directions.end(), 0.0) /
                            static_cast<double>(directions.size());
        return constraint_by(mean, directions, nodes, poses, choice, false);
    }
    return {};
}

bool has_heading_drift(const BuildingConstraint &building, const std::vector<Pose> &poses)
{
    const std::vector<HeadingPrior> &priors = building.priors;
    double sum = 0;
    for (size_t k = 0; k < priors.size(); k++) {
        const auto off = [&](size_t i) {
            return wrapped(building.direction_rad + priors[i].heading_rad - at(poses, priors[i].pose).theta);
        };
        sum += off(k);
        if (k >= run_nodes) {
            sum -= off(k - run_nodes);
        }
        if (k + 1 >= run_nodes && std::abs(sum) > run_nodes * wall_sigma_rad) {
            return true;
        }
    }
    return false;
}

bool matches_contradict(double misfit_with, double misfit_without, size_t matches, bool drifted)
{
    if (!drifted) {
        return misfit_with - misfit_without > worst_excess_undrifted * misfit_without;
    }
    const double discount = std::max(1.0, misfit_without / (clear_misfit * static_cast<double>(matches)));
    return misfit_with - misfit_without > worst_excess * discount * misfit_without;
}

} // namespace ale
