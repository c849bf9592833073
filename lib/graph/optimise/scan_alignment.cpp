#include "graph/optimise/scan_alignment.h"

#include <cmath>
#include <optional>
#include <utility>

#include "graph/optimise/mean_surface.h"

namespace ale
{

namespace
{

constexpr int sweeps = 24;         // each sweep's map is what the one before has left
constexpr double gate_m = 0.10;    // farther from the mean it is another surface
constexpr double least_points = 8; // fewer are no mean
// What a point is known to along its normal, and how many err together, as for a match of two keyframes.
constexpr double sigma_m = 0.01;
constexpr double points_a_witness = 4;
constexpr double point_information = 1 / (sigma_m * sigma_m * points_a_witness);
// How well the tracker knows the way from one scan to the next.
constexpr double way_m = 0.004;
constexpr double way_rad = 0.003;
// And the graph the heading of a scan: what many scans pull at together turns whole stretches of the way.
constexpr double graph_rad = 0.006;
constexpr double graph_information = 1 / (graph_rad * graph_rad);

SurfacePoint placed(const SurfacePoint &point, const Eigen::Matrix2d &turn, const Pose &pose)
{
    return {turn * point.p + Eigen::Vector2d(pose.x, pose.y), turn * point.normal};
}

// Hands over the points of all scans as they lie in the map.
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

MeanSurface seen_by_all(const std::vector<AlignedScan> &scans, const std::vector<Pose> &poses)
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

// Point to line, under Tukey's biweight; and to the heading that the graph knows.
PosePull pull_of(int k, const AlignedScan &scan, const Pose &pose, const MeanSurface &surface)
{
    PosePull pull{k, Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
    pull.information(2, 2) = graph_information;
    pull.pull(2) = -graph_information * wrapped(pose.theta - scan.pose.theta);
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
            pull.information += weight * j * j.transpose();
            pull.pull -= weight * residual * j;
        }
    }
    return pull;
}

} // namespace

ScanAlignment::ScanAlignment(std::vector<AlignedScan> scans) : scans_(std::move(scans))
{
    for (size_t k = 0; k < scans_.size(); k++) {
        const int here = graph_.add_pose(scans_[k].pose);
        if (k > 0 && scans_[k].tied) {
            graph_.add_edge({here - 1, here, between(scans_[k - 1].pose, scans_[k].pose),
                             known_to(way_m, way_rad), false});
        }
    }
}

bool ScanAlignment::step()
{
    if (sweep_ == sweeps || scans_.empty()) {
        return false;
    }
    const MeanSurface surface = seen_by_all(scans_, graph_.poses());
    std::vector<PosePull> pulls;
    for (size_t k = 0; k < scans_.size(); k++) {
        pulls.push_back(pull_of(static_cast<int>(k), scans_[k], graph_.poses()[k], surface));
    }
    graph_.set_pulls(std::move(pulls));
    graph_.optimise(1);
    sweep_++;
    return true;
}

} // namespace ale
