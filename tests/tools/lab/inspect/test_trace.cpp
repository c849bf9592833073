// What ale-inspect draws lies where the scanner saw it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

extern "C" {
#include "base/trig.h"
#include "lab/inspect/trace.h"
}

namespace
{

constexpr double step = 2 * M_PI / 1024;
constexpr double distance_m = 2;

/* A wall across the way, `distance_m` ahead; of the 400 beams from straight ahead to the left only the first
 * 90 see it. */
ale_scan_t wall_on_one_side()
{
    ale_scan_t scan{};
    scan.beams = 400;
    scan.step_bam = 1 << 22;
    scan.range_max_um = 5600000;
    for (uint16_t k = 0; k < 90; k++) {
        ale_scan_set_range(&scan, k,
                           static_cast<int32_t>(std::lround(distance_m / std::cos(k * step) * 1e6)));
    }
    return scan;
}

TEST(InspectTrace, PointsLieWhereTheirBeamsSawThem)
{
    const ale_scan_t scan = wall_on_one_side();
    const auto trace = std::make_unique<inspect_trace_t>();
    const ale_extract_config_t config = ale_extract_default_config();
    ASSERT_EQ(inspect_trace(&scan, &config, trace.get()), 0);
    ASSERT_EQ(trace->points, 90);
    EXPECT_FALSE(trace->smoothed);
    for (int i = 0; i < trace->points; i++) {
        EXPECT_NEAR(trace->x_um[i], distance_m * 1e6, 130)
            << "a sixteenth of a millimetre in either direction";
        EXPECT_NEAR(trace->y_um[i], distance_m * std::tan(trace->beam[i] * step) * 1e6, 130);
    }
}

TEST(InspectTrace, SmoothedPointsAreShownWhereSmoothingIsSwitchedOn)
{
    ale_scan_t scan = wall_on_one_side();
    for (uint16_t k = 0; k < 90; k++) {
        ale_scan_set_range(&scan, k, scan.range_um[k] + (k % 2 ? 4000 : -4000));
    }
    const auto trace = std::make_unique<inspect_trace_t>();
    ale_extract_config_t config = ale_extract_default_config();
    config.smooth_span = 11;
    ASSERT_EQ(inspect_trace(&scan, &config, trace.get()), 0);
    ASSERT_TRUE(trace->smoothed);
    for (int i = 10; i + 10 < trace->points; i++) {
        EXPECT_NEAR(trace->x_um[i], distance_m * 1e6, 1500) << i;
    }
}

} // namespace
