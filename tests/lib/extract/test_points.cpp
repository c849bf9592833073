// Points of random scans with holes, against a plain loop over the beams.
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#include <vector>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "extract/points.h"
}

namespace
{

// Beams of random ranges; one in `holes` has none, or one that no scanner measures.
std::unique_ptr<ale_scan_t> scan_with_holes(std::mt19937 &random, int beams, int holes)
{
    auto scan = std::make_unique<ale_scan_t>();
    const auto number = [&](int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(random);
    };
    scan->beams = static_cast<std::uint16_t>(beams);
    scan->first_bearing_bam = static_cast<std::uint32_t>(number(0, INT32_MAX));
    scan->step_bam = number(0, 1) == 0 ? 1 << 21 : -(1 << 21);
    for (int k = 0; k < beams; k++) {
        scan->range_um[k] = number(ALE_MIN_RANGE_UM, ALE_MAX_RANGE_UM);
        if (number(1, holes) == 1) {
            const int odd_ranges[] = {
                0, -1, INT32_MIN, INT32_MAX, ALE_MIN_RANGE_UM - 1, ALE_MAX_RANGE_UM + 1};
            scan->flag[k] = static_cast<std::uint8_t>(number(ALE_BEAM_VALID, ALE_BEAM_TOO_NEAR));
            scan->range_um[k] = odd_ranges[number(0, 5)];
        }
    }
    return scan;
}

bool is_valid(const ale_scan_t &scan, int k)
{
    return scan.flag[k] == ALE_BEAM_VALID && scan.range_um[k] >= ALE_MIN_RANGE_UM &&
           scan.range_um[k] <= ALE_MAX_RANGE_UM;
}

void expect_listed(const ale_scan_t &scan, const ale_points_t &points)
{
    std::vector<int> beams;
    for (int k = 0; k < scan.beams; k++) {
        if (is_valid(scan, k)) {
            beams.push_back(k);
        }
    }
    ASSERT_EQ(points.count, beams.size());
    for (std::size_t i = 0; i < beams.size(); i++) {
        EXPECT_EQ(points.beam[i], beams[i]);
        EXPECT_EQ(points.range_um[i], scan.range_um[beams[i]]);
        EXPECT_EQ(points.inverse_q44[i], (std::int64_t{1} << 44) / scan.range_um[beams[i]]);
    }
    EXPECT_EQ(points.sparse, ale_scan_is_sparse(&scan));
}

// Range times cosine or sine, in 1/16 mm, rounded half away from zero.
std::int64_t product_q4(std::int64_t range_um, std::int64_t cos_q30)
{
    return ale_round_shift(range_um * ale_round_div(cos_q30 * 128, 125), 36);
}

void expect_placed(const ale_scan_t &scan, const ale_points_t &points)
{
    for (int i = 0; i < points.count; i++) {
        const int half_steps = 2 * points.beam[i] - points.beam[0] - points.beam[points.count - 1];
        const std::int64_t aside_bam = std::int64_t{std::abs(half_steps)} * scan.step_bam / 2;
        const ale_direction_t d = ale_direction(static_cast<std::uint32_t>(aside_bam));
        const std::int64_t y_q4 = product_q4(points.range_um[i], d.sin_q30);
        EXPECT_EQ(points.x_q4[i], product_q4(points.range_um[i], d.cos_q30)) << i;
        EXPECT_EQ(points.y_q4[i], half_steps < 0 ? -y_q4 : y_q4) << i;
    }
}

TEST(Points, AreAllValidBeamsInTheirDirectionsHoweverHolesLie)
{
    std::mt19937 random(5);
    const auto points = std::make_unique<ale_points_t>();
    for (const int beams : {0, 1, 31, 32, 33, 682, ALE_MAX_BEAMS}) {
        for (const int holes : {1, 2, 3, 8, 50, 1000000}) {
            SCOPED_TRACE(testing::Message() << beams << " beams, one in " << holes << " without a range");
            const auto scan = scan_with_holes(random, beams, holes);
            ale_points_list(points.get(), scan.get(), nullptr);
            expect_listed(*scan, *points);
            ale_points_place(points.get(), scan.get(), nullptr);
            expect_placed(*scan, *points);
        }
    }
}

// A regression of 1/range over a change of it may say 0, or less: beyond all that a scanner sees.
TEST(Points, SmoothedRangesStayWithinReach)
{
    const auto points = std::make_unique<ale_points_t>();
    const int32_t smooth_q44[] = {-1000, 0, 1, 219902, 222689};
    points->count = 5;
    for (int i = 0; i < points->count; i++) {
        points->inverse_q44[i] = 222689; // 79 m
        points->x_q4[i] = 1264000;
        points->y_q4[i] = -500000;
    }
    ale_points_place_smoothed(points.get(), smooth_q44);
    for (int i = 0; i < 4; i++) {
        EXPECT_EQ(points->x_q4[i], ALE_POINT_MAX_Q4);
        EXPECT_NEAR(points->y_q4[i], -506337, 1);
    }
    EXPECT_EQ(points->x_q4[4], 1264000);
    EXPECT_EQ(points->y_q4[4], -500000);
}

} // namespace
