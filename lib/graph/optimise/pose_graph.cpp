#include "graph/optimise/pose_graph.h"

#include <algorithm>
#include <iterator>

#include <Eigen/LU>

#include "graph/optimise/normal_equations.h"

namespace ale
{

namespace
{

constexpr double converged_step = 1e-6;

Eigen::Vector3d error_of(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose seen = between(poses[static_cast<size_t>(edge.from)], poses[static_cast<size_t>(edge.to)]);
    const Pose e = between(edge.measured, seen);
    return {e.x, e.y, e.theta};
}

Eigen::Vector3d error_of(const PoseAnchor &anchor, const std::vector<Pose> &poses)
{
    const Pose e = between(anchor.measured, poses[static_cast<size_t>(anchor.pose)]);
    return {e.x, e.y, e.theta};
}

// Weight of a robust edge with Mahalanobis square chi2: s^2, s = min(1, 2 kernel / (kernel + chi2)).
double kernel_weight(double chi2, double kernel)
{
    const double s = 2 * kernel / (kernel + chi2);
    return s < 1 ? s * s : 1;
}

LinearisedEdge linearised(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose &a = poses[static_cast<size_t>(edge.from)];
    const Pose &b = poses[static_cast<size_t>(edge.to)];
    LinearisedEdge l{error_of(edge, poses), Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};
    l.to.topLeftCorner<2, 2>() = rotation(-edge.measured.theta - a.theta);
    l.carry(0, 2) = a.y - b.y;
    l.carry(1, 2) = b.x - a.x;
    return l;
}

// Towards where the pose is seen, as it stands.
PosePull pull_of(const PoseAnchor &anchor, const Eigen::Vector3d &e, double weight)
{
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = rotation(-anchor.measured.theta);
    const Eigen::Matrix3d weighted = turn.transpose() * (weight * anchor.information);
    return {anchor.pose, weighted * turn, -weighted * e};
}

double robust_cost(double chi2, double kernel)
{
    return kernel_weight(chi2, kernel) * chi2;
}

// One measurement after the other; they err independently.
GraphEdge composed(const GraphEdge &first, const GraphEdge &second, bool robust)
{
    const Eigen::Matrix3d carry = carried_over(second.measured);
    const Eigen::Matrix3d covariance =
        carry * first.information.inverse() * carry.transpose() + second.information.inverse();
    return {first.from, second.to, compose(first.measured, second.measured), covariance.inverse(), robust};
}

} // namespace

Eigen::Matrix3d known_to(double sigma_m, double sigma_rad)
{
    return Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
        .asDiagonal();
}

Eigen::Matrix3d carried_over(const Pose &step)
{
    const Pose back = inverse(step);
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    a.block<2, 2>(0, 0) = rotation(back.theta);
    a.block<2, 1>(0, 2) << back.y, -back.x;
    return a;
}

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
    headings_.building = 0;
    headings_.priors.clear();
    anchors_.clear();
    pulls_.clear();
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
    const Eigen::Vector3d e = error_of(edge, poses_);
    return e.dot(edge.information * e);
}

double PoseGraph::residual2(const PoseAnchor &anchor) const
{
    const Eigen::Vector3d e = error_of(anchor, poses_);
    return e.dot(anchor.information * e);
}

double PoseGraph::misfit(const GraphEdge &edge) const
{
    return std::min(robust_kernel, residual2(edge));
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

// Of poses above k, which is no more.
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
    follow(headings_.priors);
    follow(anchors_);
}

// The edges of pose k, which are taken out.
std::vector<GraphEdge> PoseGraph::cut_loose(int k)
{
    const auto touches = [k](const GraphEdge &edge) { return edge.from == k || edge.to == k; };
    std::vector<GraphEdge> loose;
    std::copy_if(edges_.begin(), edges_.end(), std::back_inserter(loose), touches);
    edges_.erase(std::remove_if(edges_.begin(), edges_.end(), touches), edges_.end());
    return loose;
}

void PoseGraph::take_out(int k, int max_robust)
{
    const std::vector<GraphEdge> loose = cut_loose(k);
    const auto on_the_way = [&loose](int from) {
        return *std::find_if(loose.begin(), loose.end(),
                             [from](const GraphEdge &edge) { return !edge.robust && edge.from == from; });
    };
    const GraphEdge before = on_the_way(k - 1);
    const GraphEdge after = on_the_way(k);
    edges_.push_back(composed(before, after, false));
    for (const GraphEdge &edge : loose) {
        GraphEdge moved = edge.to == k ? composed(edge, after, true) : composed(before, edge, true);
        moved.recognised = edge.recognised;
        if (edge.robust && has_room(moved, max_robust)) {
            edges_.push_back(moved);
        }
    }
    poses_.erase(poses_.begin() + k);
    renumber_above(k);
}

// The equations at the present poses; chi2 of all.
double PoseGraph::linearise(NormalEquations *equations, double kernel) const
{
    double sum = 0;
    equations->clear(anchors_.empty());
    for (size_t k = 0; k < edges_.size(); k++) {
        const LinearisedEdge l = linearised(edges_[k], poses_);
        const double chi2 = l.e.dot(edges_[k].information * l.e);
        equations->add(k, edges_[k], l, edges_[k].robust ? kernel_weight(chi2, kernel) : 1);
        sum += edges_[k].robust ? robust_cost(chi2, kernel) : chi2;
    }
    for (const HeadingPrior &prior : headings_.priors) {
        const double e =
            wrapped(poses_[static_cast<size_t>(prior.pose)].theta - headings_.building - prior.theta);
        const double chi2 = e * e * prior.information;
        equations->add(prior, e, prior.robust ? kernel_weight(chi2, kernel) : 1);
        sum += prior.robust ? robust_cost(chi2, kernel) : chi2;
    }
    for (const PoseAnchor &anchor : anchors_) {
        const Eigen::Vector3d e = error_of(anchor, poses_);
        const double chi2 = e.dot(anchor.information * e);
        equations->add(pull_of(anchor, e, kernel_weight(chi2, kernel)));
        sum += robust_cost(chi2, kernel);
    }
    for (const PosePull &pull : pulls_) {
        equations->add(pull);
    }
    return sum;
}

void PoseGraph::move(const NormalEquations &equations)
{
    for (size_t k = 0; k < poses_.size(); k++) {
        const Eigen::Vector3d step = equations.step(k);
        poses_[k] = {poses_[k].x + step(0), poses_[k].y + step(1), wrapped(poses_[k].theta + step(2))};
    }
    headings_.building += equations.building_step();
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
