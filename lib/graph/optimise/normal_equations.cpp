#include "graph/optimise/normal_equations.h"

#include <cmath>

namespace ale
{

namespace
{

constexpr double damping = 1e-9;
constexpr double held = 1e12; // of a pose that stays where it is

std::vector<BlockCholesky::Pair> pairs_of(const std::vector<GraphEdge> &edges)
{
    std::vector<BlockCholesky::Pair> pairs;
    pairs.reserve(edges.size());
    for (const GraphEdge &edge : edges) {
        pairs.emplace_back(edge.from, edge.to);
    }
    return pairs;
}

} // namespace

NormalEquations::NormalEquations(size_t poses, const std::vector<GraphEdge> &edges)
    : h_(poses, pairs_of(edges)), x_(static_cast<Eigen::Index>(3 * poses)), border_(x_.size())
{
}

void NormalEquations::clear(bool hold_first)
{
    h_.clear();
    const auto poses = static_cast<int>(x_.size() / 3);
    for (int k = 0; k < poses; k++) {
        h_.add_diagonal(k, Eigen::Matrix3d::Identity() * (k == 0 && hold_first ? held : damping));
    }
    x_.setZero();
    border_.setZero();
    corner_ = damping;
    building_ = 0;
}

void NormalEquations::hold(size_t pose)
{
    h_.add_diagonal(static_cast<int>(pose), Eigen::Matrix3d::Identity() * held);
}

void NormalEquations::add(size_t k, const GraphEdge &edge, const LinearisedEdge &linearised, double weight)
{
    const Eigen::Matrix3d weighted = linearised.jacobian.transpose() * (weight * edge.information);
    const Eigen::Matrix3d to_block = weighted * linearised.jacobian;
    const Eigen::Matrix3d from_to = linearised.transfer.transpose() * to_block;
    h_.add_diagonal(edge.to, to_block);
    h_.add_diagonal(edge.from, from_to * linearised.transfer);
    h_.add(k, -from_to);
    const Eigen::Vector3d gradient = weighted * linearised.residual;
    x_.segment<3>(Eigen::Index{3} * edge.to) -= gradient;
    x_.segment<3>(Eigen::Index{3} * edge.from) += linearised.transfer.transpose() * gradient;
}

void NormalEquations::add(const HeadingPrior &prior, double residual_rad, double weight)
{
    const double omega = weight * prior.information;
    const Eigen::Index theta = Eigen::Index{3} * prior.pose + 2;
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    block(2, 2) = omega;
    h_.add_diagonal(prior.pose, block);
    border_(theta) -= omega;
    corner_ += omega;
    x_(theta) -= omega * residual_rad;
    building_ += omega * residual_rad;
}

void NormalEquations::add(const LinearisedPrior &prior)
{
    h_.add_diagonal(prior.pose, prior.information);
    x_.segment<3>(Eigen::Index{3} * prior.pose) += prior.right_side;
}

bool NormalEquations::solve()
{
    if (!h_.factorise()) {
        return false;
    }
    h_.solve(&x_);
    building_step_ = 0;
    if (!border_.isZero(0)) {
        solve_for_building();
    }
    return true;
}

// By the Schur complement of the building's direction.
void NormalEquations::solve_for_building()
{
    Eigen::VectorXd response = border_;
    h_.solve(&response);
    const double remaining = corner_ - border_.dot(response);
    if (remaining > 0) {
        building_step_ = (building_ - border_.dot(x_)) / remaining;
        x_ -= building_step_ * response;
    }
}

double NormalEquations::largest_step() const
{
    return std::max(x_.lpNorm<Eigen::Infinity>(), std::abs(building_step_));
}

} // namespace ale
