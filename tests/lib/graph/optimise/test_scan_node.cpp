// lib/graph/optimise/scan_node.cpp: points of a scan with the normals of its surfaces, against the walls.
#include <memory>

#include <gtest/gtest.h>

#include "graph/optimise/scan_node.h"

namespace
{

constexpr double wall_m = 2; // ahead of the sensor

// A wall across the view, no lines. every: beams from one echo to the next.
std::vector<ale::SurfacePoint> points_of_wall(int every)
{
    const auto scan = std::make_unique<ale_scan_t>();
    *scan = {};
    scan->beams = 181;
    scan->step_bam = static_cast<int32_t>((int64_t{1} << 32) / 720);
    scan->first_bearing_bam = 0U - 90U * static_cast<uint32_t>(scan->step_bam);
    scan->range_min_um = 20000;
    scan->range_max_um = 20000000;
    for (uint16_t k = 0; k < scan->beams; k++) {
        const double bearing = (k - 90) * ale::pi / 360;
        ale_scan_set_range(scan.get(), k,
                           k % every == 0 ? static_cast<int32_t>(wall_m * 1e6 / ale::cosine(bearing)) : 0);
    }
    const auto features = std::make_unique<ale_features_t>();
    const ale_seen_t seen = {{scan.get(), nullptr, {0, 0, 0}}, {0, 0, 0}, nullptr, 0};
    return ale::surface_of(seen, *features);
}

TEST(ScanNode, PointsOffTheLinesHaveTheNormalOfTheirSurface)
{
    for (const int every : {1, 2, 4}) {
        const auto points = points_of_wall(every);
        EXPECT_GT(points.size(), 30U) << every;
        for (const ale::SurfacePoint &point : points) {
            EXPECT_NEAR(point.p.x(), wall_m, 1e-5);
            EXPECT_NEAR(point.normal.x(), -1, 1e-4);
        }
    }
}

} // namespace
