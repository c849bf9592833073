#include "graph/optimise/pose_graph.h"

#include <algorithm>
#include <iterator>

#include <Eigen/LU>

#include "graph/optimise/normal_equations.h"

namespace ale
{

namespace
{

constexpr double converged_step = 1e-6; // metres, radians

Eigen::Vector3d residual_of(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose e = between(edge.measured, between(poses, edge.from, edge.to));
    return {e.x, e.y, e.theta};
}

Eigen::Vector3d residual_of(const PosePrior &prior, const std::vector<Pose> &poses)
{
    const Pose e = between(prior.measured, at(poses, prior.pose));
    return {e.x, e.y, e.theta};
}

double residual_of(const HeadingPrior &prior, const BuildingConstraint &building,
                   const std::vector<Pose> &poses)
{
    return wrapped(at(poses, prior.pose).theta - building.direction_rad - prior.heading_rad);
}

// Weight of a robust edge with Mahalanobis square chi2: s^2, s = min(1, 2 kernel / (kernel + chi2)).
double kernel_weight(double chi2, double kernel)
{
    const double s = 2 * kernel / (kernel + chi2);
    return s < 1 ? s * s : 1;
}

// The integral of that weight over chi2.
double kernel_cost(double chi2, double kernel)
{
    return chi2 < kernel ? chi2 : 3 * kernel - 4 * kernel * kernel / (kernel + chi2);
}

LinearisedEdge linearised(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose &a = at(poses, edge.from);
    const Pose &b = at(poses, edge.to);
    LinearisedEdge l{residual_of(edge, poses), Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
    l.jacobian.topLeftCorner<2, 2>() = rotation(-edge.measured.theta - a.theta);
    l.transfer(0, 2) = a.y - b.y;
    l.transfer(1, 2) = b.x - a.x;
    return l;
}

LinearisedPrior linearised(const PosePrior &prior, const Eigen::Vector3d &e, double weight)
{
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = rotation(-prior.measured.theta);
    const Eigen::Matrix3d weighted = turn.transpose() * (weight * prior.information);
    return {prior.pose, weighted * turn, -weighted * e};
}

double robust_cost(double chi2, double kernel)
{
    return kernel_weight(chi2, kernel) * chi2;
}

// One measurement after the other; their errors are independent.
GraphEdge composed(const GraphEdge &first, const GraphEdge &second, bool robust)
{
    const Eigen::Matrix3d jacobian = displacement_jacobian(second.measured);
    const Eigen::Matrix3d covariance =
        jacobian * first.information.inverse() * jacobian.transpose() + second.information.inverse();
    return {first.from,
            second.to,
            compose(first.measured, second.measured),
            covariance.inverse(),
            robust,
            false,
            std::max(first.guess, second.guess),
            false,
            std::max(first.reach_m, second.reach_m)};
}

} // namespace

void PoseGraph::reserve(size_t poses, size_t edges)
{
    poses_.resize(poses);
    edges_.resize(edges);
    clear();
}

void PoseGraph::clear()
{
    poses_.clear();
    edges_.clear();
    building_.direction_rad = 0;
    building_.priors.clear();
    pose_priors_.clear();
    linearised_priors_.clear();
    held_.clear();
}

int PoseGraph::add_pose(const Pose &pose)
{
    poses_.push_back(pose);
    return static_cast<int>(poses_.size()) - 1;
}

void PoseGraph::add_edge(const GraphEdge &edge)
{
    edges_.push_back(edge);
}

double PoseGraph::residual2(const GraphEdge &edge) const
{
    const Eigen::Vector3d e = residual_of(edge, poses_);
    return e.dot(edge.information * e);
}

double PoseGraph::residual2(const PosePrior &prior) const
{
    const Eigen::Vector3d e = residual_of(prior, poses_);
    return e.dot(prior.information * e);
}

double PoseGraph::misfit(const GraphEdge &edge) const
{
    return std::min(robust_kernel, residual2(edge));
}

double PoseGraph::cost() const
{
    double sum = 0;
    const auto add = [&sum](double chi2, bool robust) {
        sum += robust ? kernel_cost(chi2, robust_kernel) : chi2;
    };
    for (const GraphEdge &edge : edges_) {
        add(residual2(edge), edge.robust);
    }
    for (const HeadingPrior &prior : building_.priors) {
        const double e = residual_of(prior, building_, poses_);
        add(e * e * prior.information, prior.robust);
    }
    for (const PosePrior &prior : pose_priors_) {
        add(residual2(prior), true);
    }
    return sum;
}

double PoseGraph::weight(const GraphEdge &edge) const
{
    return edge.robust ? kernel_weight(residual2(edge), robust_kernel) : 1;
}

bool PoseGraph::has_room(const GraphEdge &edge, int max_robust) const
{
    int ending_there = 0;
    for (const GraphEdge &other : edges_) {
        if (other.robust && other.to == edge.to) {
            ending_there++;
            if (other.from == edge.from) {
                return false;
            }
        }
    }
    return ending_there < max_robust;
}

// Poses above k move down by one; what ties k is dropped.
void PoseGraph::renumber_above(int k)
{
    const auto moved = [k](int pose) { return pose > k ? pose - 1 : pose; };
    for (GraphEdge &edge : edges_) {
        edge.from = moved(edge.from);
        edge.to = moved(edge.to);
    }
    const auto follow = [&](auto &those) {
        those.erase(
            std::remove_if(those.begin(), those.end(), [k](const auto &one) { return one.pose == k; }),
            those.end());
        for (auto &one : those) {
            one.pose = moved(one.pose);
        }
    };
    follow(building_.priors);
    follow(pose_priors_);
}

// Takes the edges of pose k out of the graph; these.
std::vector<GraphEdge> PoseGraph::remove_edges_of(int k)
{
    const auto touches = [k](const GraphEdge &edge) { return edge.from == k || edge.to == k; };
    std::vector<GraphEdge> removed;
    std::copy_if(edges_.begin(), edges_.end(), std::back_inserter(removed), touches);
    edges_.erase(std::remove_if(edges_.begin(), edges_.end(), touches), edges_.end());
    return removed;
}

void PoseGraph::remove_pose(int k, int max_robust)
{
    const std::vector<GraphEdge> removed = remove_edges_of(k);
    const auto odometry_from = [&removed](int from) {
        return *std::find_if(removed.begin(), removed.end(),
                             [from](const GraphEdge &edge) { return !edge.robust && edge.from == from; });
    };
    const GraphEdge before = odometry_from(k - 1);
    const GraphEdge after = odometry_from(k);
    edges_.push_back(composed(before, after, false));
    for (const GraphEdge &edge : removed) {
        GraphEdge moved = edge.to == k ? composed(edge, after, true) : composed(before, edge, true);
        moved.recognised = edge.recognised;
        moved.joins = edge.joins;
        if (edge.robust && moved.guess == Guess::none && has_room(moved, max_robust)) {
            edges_.push_back(moved);
        }
    }
    poses_.erase(poses_.begin() + k);
    renumber_above(k);
}

void PoseGraph::move_rigidly(const std::vector<bool> &moved, const Pose &shift)
{
    for (size_t k = 0; k < poses_.size(); k++) {
        if (moved[k]) {
            poses_[k] = compose(shift, poses_[k]);
        }
    }
    for (GraphEdge &edge : edges_) {
        // What wheels have told of the way stays.
        if (edge.guess == Guess::near || edge.guess == Guess::anywhere) {
            edge.measured = between(poses_, edge.from, edge.to);
            edge.information = guess_information();
        }
    }
    building_ = {};
}

// Sums the equations at the present poses; the weighted chi2 of all constraints.
double PoseGraph::linearise(NormalEquations *equations, double kernel) const
{
    double sum = 0;
    equations->clear(pose_priors_.empty());
    for (size_t k = 0; k < held_.size(); k++) {
        if (held_[k]) {
            equations->hold(k);
        }
    }
    for (size_t k = 0; k < edges_.size(); k++) {
        const LinearisedEdge l = linearised(edges_[k], poses_);
        const double chi2 = l.residual.dot(edges_[k].information * l.residual);
        equations->add(k, edges_[k], l, edges_[k].robust ? kernel_weight(chi2, kernel) : 1);
        sum += edges_[k].robust ? robust_cost(chi2, kernel) : chi2;
    }
    for (const HeadingPrior &prior : building_.priors) {
        const double e = residual_of(prior, building_, poses_);
        const double chi2 = e * e * prior.information;
        equations->add(prior, e, prior.robust ? kernel_weight(chi2, kernel) : 1);
        sum += prior.robust ? robust_cost(chi2, kernel) : chi2;
    }
    for (const PosePrior &prior : pose_priors_) {
        const Eigen::Vector3d e = residual_of(prior, poses_);
        const double chi2 = e.dot(prior.information * e);
        equations->add(linearised(prior, e, kernel_weight(chi2, kernel)));
        sum += robust_cost(chi2, kernel);
    }
    for (const LinearisedPrior &prior : linearised_priors_) {
        equations->add(prior);
    }
    return sum;
}

void PoseGraph::move(const NormalEquations &equations)
{
    for (size_t k = 0; k < poses_.size(); k++) {
        const Eigen::Vector3d step = equations.step(k);
        poses_[k] = {poses_[k].x + step(0), poses_[k].y + step(1), wrapped(poses_[k].theta + step(2))};
    }
    building_.direction_rad += equations.building_step();
}

GraphReport PoseGraph::optimise(int max_iterations, double kernel)
{
    GraphReport report{0, 0, true};
    NormalEquations equations(poses_.size(), edges_);
    while (report.iterations < max_iterations) {
        report.chi2 = linearise(&equations, kernel);
        report.solved = equations.solve();
        if (!report.solved) {
            break;
        }
        report.iterations++;
        move(equations);
        if (equations.largest_step() < converged_step) {
            break;
        }
    }
    return report;
}

} // namespace ale
