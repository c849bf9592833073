#include "graph/pose_graph.h"

#include <algorithm>
#include <iterator>

#include <Eigen/LU>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace ale
{

namespace
{

// A robust edge keeps its full weight up to this Mahalanobis square, then fades.
constexpr double robust_phi = 10;
constexpr double converged_step = 1e-6;

Eigen::Vector3d error_of(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose seen = between(poses[static_cast<size_t>(edge.from)], poses[static_cast<size_t>(edge.to)]);
    const Pose e = between(edge.measured, seen);
    return {e.x, e.y, e.theta};
}

// Weight of a robust edge with Mahalanobis square chi2: s^2, s = min(1, 2 phi / (phi + chi2)).
double kernel_weight(double chi2)
{
    const double s = 2 * robust_phi / (robust_phi + chi2);
    return s < 1 ? s * s : 1;
}

struct Linearised {
    Eigen::Matrix3d from;
    Eigen::Matrix3d to;
};

// Derivatives of the error by the two poses, Euclidean increments of (x, y, theta).
Linearised jacobians(const GraphEdge &edge, const std::vector<Pose> &poses)
{
    const Pose &a = poses[static_cast<size_t>(edge.from)];
    const Pose &b = poses[static_cast<size_t>(edge.to)];
    const Eigen::Matrix2d to_measured = rotation(-edge.measured.theta);
    const Eigen::Matrix2d to_from = rotation(-a.theta);
    Eigen::Matrix2d turned; // d R(-theta) / d theta
    turned.row(0) << -sine(a.theta), cosine(a.theta);
    turned.row(1) << -cosine(a.theta), -sine(a.theta);
    const Eigen::Vector2d d(b.x - a.x, b.y - a.y);
    Linearised j{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
    j.from.block<2, 2>(0, 0) = -to_measured * to_from;
    j.from.block<2, 1>(0, 2) = to_measured * turned * d;
    j.from(2, 2) = -1;
    j.to.block<2, 2>(0, 0) = to_measured * to_from;
    j.to(2, 2) = 1;
    return j;
}

// The normal equations h step = -gradient, edge by edge: three unknowns a pose, and last the building's
// direction.
class Assembler
{
  public:
    Assembler(size_t poses, size_t edges, size_t priors)
        : b_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * poses + 1)))
    {
        triplets_.reserve(36 * edges + 4 * priors + 3 * poses + 1);
    }

    void add(const GraphEdge &edge, const Linearised &j, const Eigen::Vector3d &e, double weight)
    {
        const Eigen::Matrix3d omega = weight * edge.information;
        block(edge.from, edge.from, j.from.transpose() * omega * j.from);
        block(edge.from, edge.to, j.from.transpose() * omega * j.to);
        block(edge.to, edge.from, j.to.transpose() * omega * j.from);
        block(edge.to, edge.to, j.to.transpose() * omega * j.to);
        b_.segment<3>(Eigen::Index{3} * edge.from) += j.from.transpose() * omega * e;
        b_.segment<3>(Eigen::Index{3} * edge.to) += j.to.transpose() * omega * e;
    }

    void add(const HeadingPrior &prior, double e, double weight)
    {
        const Eigen::Index theta = Eigen::Index{3} * prior.pose + 2;
        const Eigen::Index building = b_.size() - 1;
        const double omega = weight * prior.information;
        triplets_.emplace_back(theta, theta, omega);
        triplets_.emplace_back(theta, building, -omega);
        triplets_.emplace_back(building, theta, -omega);
        triplets_.emplace_back(building, building, omega);
        b_(theta) += omega * e;
        b_(building) -= omega * e;
    }

    const Eigen::VectorXd &gradient() const
    {
        return b_;
    }

    // The first pose is held.
    void write(double damping, Eigen::SparseMatrix<double> *h)
    {
        for (Eigen::Index k = 0; k < b_.size(); k++) {
            triplets_.emplace_back(k, k, k < 3 ? 1e12 : damping);
        }
        h->resize(b_.size(), b_.size());
        h->setFromTriplets(triplets_.begin(), triplets_.end());
    }

  private:
    void block(Eigen::Index row, Eigen::Index column, const Eigen::Matrix3d &m)
    {
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++) {
                triplets_.emplace_back(3 * row + r, 3 * column + c, m(r, c));
            }
        }
    }

    std::vector<Eigen::Triplet<double, Eigen::Index>> triplets_;
    Eigen::VectorXd b_;
};

double robust_cost(double chi2)
{
    return kernel_weight(chi2) * chi2;
}

// What a displacement of a pose, seen in its own frame, is in the frame of another that `step` leads to.
Eigen::Matrix3d carried_over(const Pose &step)
{
    const Pose back = inverse(step);
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    a.block<2, 2>(0, 0) = rotation(back.theta);
    a.block<2, 1>(0, 2) << back.y, -back.x;
    return a;
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
    std::vector<HeadingPrior> &priors = headings_.priors;
    priors.erase(std::remove_if(priors.begin(), priors.end(),
                                [k](const HeadingPrior &prior) { return prior.pose == k; }),
                 priors.end());
    for (HeadingPrior &prior : priors) {
        prior.pose = moved(prior.pose);
    }
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

GraphReport PoseGraph::optimise(int max_iterations)
{
    GraphReport report{0, 0, true};
    Eigen::SparseMatrix<double> h;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    for (; report.iterations < max_iterations; report.iterations++) {
        Assembler assembler(poses_.size(), edges_.size(), headings_.priors.size());
        report.chi2 = 0;
        for (const GraphEdge &edge : edges_) {
            const Eigen::Vector3d e = error_of(edge, poses_);
            const double chi2 = e.dot(edge.information * e);
            assembler.add(edge, jacobians(edge, poses_), e, edge.robust ? kernel_weight(chi2) : 1);
            report.chi2 += edge.robust ? robust_cost(chi2) : chi2;
        }
        for (const HeadingPrior &prior : headings_.priors) {
            const double e =
                wrapped(poses_[static_cast<size_t>(prior.pose)].theta - headings_.building - prior.theta);
            const double chi2 = e * e * prior.information;
            assembler.add(prior, e, kernel_weight(chi2));
            report.chi2 += robust_cost(chi2);
        }
        assembler.write(1e-9, &h);
        if (report.iterations == 0) {
            solver.analyzePattern(h);
        }
        solver.factorize(h);
        if (solver.info() != Eigen::Success) {
            report.solved = false;
            return report;
        }
        const Eigen::VectorXd step = solver.solve(-assembler.gradient());
        for (size_t k = 0; k < poses_.size(); k++) {
            const auto i = static_cast<Eigen::Index>(3 * k);
            poses_[k] = {poses_[k].x + step(i), poses_[k].y + step(i + 1),
                         wrapped(poses_[k].theta + step(i + 2))};
        }
        headings_.building += step(step.size() - 1);
        if (step.lpNorm<Eigen::Infinity>() < converged_step) {
            break;
        }
    }
    return report;
}

} // namespace ale
