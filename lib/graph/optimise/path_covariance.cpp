#include "graph/optimise/path_covariance.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include <Eigen/LU>

namespace ale
{

namespace
{

constexpr double least_weight = 0.25; // of a robust edge that is used
constexpr double unknown = 1e6;       // variance

double largest_deviation(const Eigen::Matrix3d &covariance)
{
    const double mean = (covariance(0, 0) + covariance(1, 1)) / 2;
    const double half = (covariance(0, 0) - covariance(1, 1)) / 2;
    return std::sqrt(mean + length(half, covariance(0, 1)));
}

} // namespace

PathCovariance::PathCovariance(const PoseGraph &graph) : steps_(graph.poses().size())
{
    for (const GraphEdge &edge : graph.edges()) {
        const double weight = graph.weight(edge);
        if (edge.guess != Guess::none || weight < least_weight) {
            continue;
        }
        const Eigen::Matrix3d covariance = edge.information.inverse() / weight;
        const Eigen::Matrix3d forth = displacement_jacobian(edge.measured);
        const Eigen::Matrix3d back = displacement_jacobian(inverse(edge.measured));
        steps_[static_cast<size_t>(edge.from)].push_back({edge.to, forth, covariance});
        steps_[static_cast<size_t>(edge.to)].push_back(
            {edge.from, back, back * covariance * back.transpose()});
    }
}

// Ordered by the trace of the covariance: a radian counts as a metre.
std::vector<Deviation> PathCovariance::from(int k) const
{
    using Reached = std::pair<double, int>;
    std::vector<Eigen::Matrix3d> covariance(steps_.size(), Eigen::Matrix3d::Identity() * unknown);
    std::vector<bool> settled(steps_.size(), false);
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    covariance[static_cast<size_t>(k)].setZero();
    queue.push({0, k});
    while (!queue.empty()) {
        const auto at = static_cast<size_t>(queue.top().second);
        queue.pop();
        if (settled[at]) {
            continue;
        }
        settled[at] = true;
        for (const Step &step : steps_[at]) {
            const Eigen::Matrix3d there =
                step.jacobian * covariance[at] * step.jacobian.transpose() + step.covariance;
            Eigen::Matrix3d &known = covariance[static_cast<size_t>(step.to)];
            if (there.trace() < known.trace()) {
                known = there;
                queue.push({there.trace(), step.to});
            }
        }
    }
    std::vector<Deviation> deviations;
    deviations.reserve(steps_.size());
    for (const Eigen::Matrix3d &c : covariance) {
        deviations.push_back({largest_deviation(c), std::sqrt(c(2, 2))});
    }
    return deviations;
}

} // namespace ale
