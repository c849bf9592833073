#include "graph/optimise/path_spread.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include <Eigen/LU>

namespace ale
{

namespace
{

constexpr double least_weight = 0.25; // of a robust edge
constexpr double unknown = 1e6;       // variance

double largest_deviation(const Eigen::Matrix3d &covariance)
{
    const double mean = (covariance(0, 0) + covariance(1, 1)) / 2;
    const double half = (covariance(0, 0) - covariance(1, 1)) / 2;
    return std::sqrt(mean + length(half, covariance(0, 1)));
}

} // namespace

PathSpread::PathSpread(const PoseGraph &graph) : ways_(graph.poses().size())
{
    for (const GraphEdge &edge : graph.edges()) {
        const double weight = graph.weight(edge);
        if (weight < least_weight) {
            continue;
        }
        const Eigen::Matrix3d covariance = edge.information.inverse() / weight;
        const Eigen::Matrix3d forth = carried_over(edge.measured);
        const Eigen::Matrix3d back = carried_over(inverse(edge.measured));
        ways_[static_cast<size_t>(edge.from)].push_back({edge.to, forth, covariance});
        ways_[static_cast<size_t>(edge.to)].push_back(
            {edge.from, back, back * covariance * back.transpose()});
    }
}

// Dijkstra's algorithm, by the trace of the covariance: a radian counts as a metre.
std::vector<Spread> PathSpread::from(int k) const
{
    using Reached = std::pair<double, int>;
    std::vector<Eigen::Matrix3d> covariance(ways_.size(), Eigen::Matrix3d::Identity() * unknown);
    std::vector<bool> settled(ways_.size(), false);
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
        for (const Way &way : ways_[at]) {
            const Eigen::Matrix3d there = way.carry * covariance[at] * way.carry.transpose() + way.covariance;
            Eigen::Matrix3d &known = covariance[static_cast<size_t>(way.to)];
            if (there.trace() < known.trace()) {
                known = there;
                queue.push({there.trace(), way.to});
            }
        }
    }
    std::vector<Spread> spread;
    spread.reserve(ways_.size());
    for (const Eigen::Matrix3d &c : covariance) {
        spread.push_back({largest_deviation(c), std::sqrt(c(2, 2))});
    }
    return spread;
}

} // namespace ale
