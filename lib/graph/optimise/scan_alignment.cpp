#include "graph/optimise/scan_alignment.h"

#include <cmath>
#include <optional>
#include <utility>

#include "graph/optimise/mean_surface.h"

namespace ale
{

namespace
{

constexpr int sweeps = 24;         // each makes the map of the poses that the one before has left
constexpr double gate_m = 0.10;    // farther from the mean it is another surface
constexpr double least_points = 8; // fewer are no mean
// Error of a point along its normal, and how many neighbours share it, as in a match of two keyframes.
constexpr double sigma_m = 0.01;
constexpr double correlated_points = 4;
constexpr double point_information = 1 / (sigma_m * sigma_m * correlated_points);
// Error of the tracker from one scan to the next.
constexpr double tracked_m = 0.004;
constexpr double tracked_rad = 0.003;
// Error of a heading in the graph. Without this prior, walls that many scans see bent turn whole stretches.
constexpr double heading_rad = 0.006;
constexpr double heading_information = 1 / (heading_rad * heading_rad);

SurfacePoint placed(const SurfacePoint &point, const Eigen::Matrix2d &turn, const Pose &pose)
{
    return {turn * point.p + Eigen::Vector2d(pose.x, pose.y), turn * point.normal};
}

// Calls put(point) for the points of all scans, map frame.
template <class Put>
void each_point(const std::vector<AlignedScan> &scans, const std::vector<Pose> &poses, const Put &put)
{
    for (size_t k = 0; k < scans.size(); k++) {
        const Eigen::Matrix2d turn = rotation(poses[k].theta);
        for (const SurfacePoint &point : scans[k].points) {
            put(placed(point, turn, poses[k]));
        }
    }
}

MeanSurface mean_of(const std::vector<AlignedScan> &scans, const std::vector<Pose> &poses)
{
    Eigen::Vector2d low(1e9, 1e9);
    Eigen::Vector2d high(-1e9, -1e9);
    each_point(scans, poses, [&](const SurfacePoint &point) {
        low = low.cwiseMin(point.p);
        high = high.cwiseMax(point.p);
    });
    MeanSurface surface(low, high);
    each_point(scans, poses, [&](const SurfacePoint &point) { surface.add(point); });
    return surface;
}

// Point to line, under Tukey's biweight, and the prior of the heading.
LinearisedPrior linearised(int k, const AlignedScan &scan, const Pose &pose, const MeanSurface &surface)
{
    LinearisedPrior prior{k, Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
    prior.information(2, 2) = heading_information;
    prior.right_side(2) = -heading_information * wrapped(pose.theta - scan.pose.theta);
    const Eigen::Matrix2d turn = rotation(pose.theta);
    for (const SurfacePoint &point : scan.points) {
        const SurfacePoint here = placed(point, turn, pose);
        const std::optional<SurfacePoint> mean = surface.around(here, least_points);
        if (!mean) {
            continue;
        }
        const Eigen::Vector2d &n = mean->normal;
        const Eigen::Vector2d lever = here.p - Eigen::Vector2d(pose.x, pose.y);
        const double residual = n.dot(here.p - mean->p);
        const double x = residual / gate_m;
        if (std::abs(x) < 1) {
            const Eigen::Vector3d j(n.x(), n.y(), lever.x() * n.y() - lever.y() * n.x());
            const double weight = (1 - x * x) * (1 - x * x) * point_information;
            prior.information += weight * j * j.transpose();
            prior.right_side -= weight * residual * j;
        }
    }
    return prior;
}

} // namespace

ScanAlignment::ScanAlignment(std::vector<AlignedScan> scans) : scans_(std::move(scans))
{
    for (size_t k = 0; k < scans_.size(); k++) {
        const int here = graph_.add_pose(scans_[k].pose);
        if (k > 0 && scans_[k].tied) {
            graph_.add_edge({here - 1, here, between(scans_[k - 1].pose, scans_[k].pose),
                             information_from_deviations(tracked_m, tracked_rad), false});
        }
    }
}

bool ScanAlignment::step()
{
    if (sweep_ == sweeps || scans_.empty()) {
        return false;
    }
    const MeanSurface surface = mean_of(scans_, graph_.poses());
    std::vector<LinearisedPrior> priors;
    for (size_t k = 0; k < scans_.size(); k++) {
        priors.push_back(linearised(static_cast<int>(k), scans_[k], graph_.poses()[k], surface));
    }
    graph_.set_linearised_priors(std::move(priors));
    graph_.optimise(1);
    sweep_++;
    return true;
}

} // namespace ale
