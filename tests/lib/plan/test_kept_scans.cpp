// lib/plan/kept_scans.c: a grid drawn again where the past has moved, against one drawn by the true way.
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "plan/kept_scans.h"
}

namespace
{

constexpr int32_t radius_um = 200000;

// What the way as it was tracked makes of the truth: from the tenth second on the robot believes to be
// elsewhere.
constexpr int astray_from = 100;
const reference::Pose astray{0.25, -0.15, 0.05};

struct Walk {
    std::unique_ptr<ale_kept_scans_t> kept = std::make_unique<ale_kept_scans_t>();
    std::unique_ptr<ale_straight_scan_t> spare = std::make_unique<ale_straight_scan_t>();
    std::unique_ptr<ale_grid_t> tracked = std::make_unique<ale_grid_t>();
    std::unique_ptr<ale_grid_t> truth = std::make_unique<ale_grid_t>();

    Walk()
    {
        ale_kept_scans_clear(kept.get());
        ale_grid_init(tracked.get(), {0, 0});
        ale_grid_init(truth.get(), {0, 0});
    }

    void take(int number)
    {
        room::Sensor sensor;
        sensor.beam_time_ns = 0;
        sensor.noise = 0.003;
        const reference::Pose pose = room::path(0.1 * number);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, 0.1 * number, rng);
        for (int k = 0; k < scan.beams; k++) {
            spare->bearing_bam[k] = ale_scan_bearing(&scan, k);
        }
        const ale_pose_t believed =
            convert::pose(number < astray_from ? pose : reference::compose(astray, pose));
        add(*truth, scan, convert::pose(pose));
        add(*tracked, scan, believed);
        ale_kept_scans_offer(kept.get(), static_cast<uint32_t>(number), &scan, spare->bearing_bam, believed);
    }

    void add(ale_grid_t &grid, const ale_scan_t &scan, ale_pose_t pose) const
    {
        ale_grid_add_scan(&grid, &scan, spare->bearing_bam, pose);
        ale_grid_add_disc(&grid, {pose.x_um, pose.y_um}, radius_um);
    }

    void draw()
    {
        ale_grid_clear(tracked.get());
        ale_kept_scans_draw(kept.get(), {0, 0, 0}, radius_um, tracked.get(), spare.get());
    }

    std::mt19937 rng{3};
};

std::unique_ptr<ale_correction_t> back_to_the_truth()
{
    auto correction = std::make_unique<ale_correction_t>();
    correction->count = 2;
    correction->shift[1] = {astray_from, convert::pose(reference::inverse(astray))};
    return correction;
}

// Parts of the cells that the truth knows as free or occupied of which the other says the opposite, and
// nothing.
struct Difference {
    double wrong = 0;
    double unknown = 0;
};

Difference between(const ale_grid_t &truth, const ale_grid_t &other)
{
    Difference d;
    double known = 0;
    for (uint32_t cell = 0; cell < ALE_GRID_CELLS; cell++) {
        const bool is_free = ale_grid_is_free(&truth, cell);
        if (!is_free && !ale_grid_is_occupied(&truth, cell)) {
            continue;
        }
        known++;
        d.unknown += ale_grid_is_unknown(&other, cell);
        d.wrong += is_free ? ale_grid_is_occupied(&other, cell) : ale_grid_is_free(&other, cell);
    }
    d.wrong /= known;
    d.unknown /= known;
    return d;
}

} // namespace

TEST(KeptScans, AGridDrawnAgainIsTheOneThatTheTrueWayWouldHaveDrawn)
{
    Walk walk;
    for (int number = 0; number < 200; number++) {
        walk.take(number);
    }
    EXPECT_GT(between(*walk.truth, *walk.tracked).wrong, 0.03) << "walls are drawn twice";
    EXPECT_TRUE(ale_kept_scans_correct(walk.kept.get(), back_to_the_truth().get()));
    walk.draw();
    const Difference after = between(*walk.truth, *walk.tracked);
    EXPECT_LT(after.wrong, 0.01);
    EXPECT_LT(after.unknown, 0.005);
}

TEST(KeptScans, WhereTheRobotDroveItWasFree)
{
    Walk walk;
    for (int number = 0; number < 60; number++) {
        walk.take(number);
    }
    walk.draw();
    for (int number = 0; number < 55; number++) {
        const ale_pose_t pose = convert::pose(room::path(0.1 * number));
        const ale_cell_t cell = ale_grid_cell(walk.tracked.get(), {pose.x_um, pose.y_um});
        EXPECT_TRUE(ale_grid_is_free(walk.tracked.get(), cell)) << number;
        EXPECT_TRUE(ale_grid_was_visited(walk.tracked.get(), cell)) << number;
    }
}

TEST(KeptScans, WhatMovesByLessThanHalfACellIsNotDrawnAgainUntilItAddsUp)
{
    Walk walk;
    walk.take(0);
    auto correction = back_to_the_truth();
    correction->shift[0].shift = {10000, 0, 0};
    EXPECT_FALSE(ale_kept_scans_correct(walk.kept.get(), correction.get()));
    EXPECT_FALSE(ale_kept_scans_correct(walk.kept.get(), correction.get()));
    EXPECT_TRUE(ale_kept_scans_correct(walk.kept.get(), correction.get()));
    walk.draw();
    EXPECT_FALSE(ale_kept_scans_correct(walk.kept.get(), correction.get()));
}

TEST(KeptScans, OnALongWayTheyLieFartherApartAndReachFromTheFirstToTheLast)
{
    const auto kept = std::make_unique<ale_kept_scans_t>();
    ale_kept_scans_clear(kept.get());
    const ale_scan_t nothing = {};
    const uint32_t bearings[1] = {0};
    const int32_t last = 20000; // 2 km by steps of 10 cm
    for (int32_t k = 0; k <= last; k++) {
        ale_kept_scans_offer(kept.get(), static_cast<uint32_t>(k), &nothing, bearings, {k * 100000, 0, 0});
        ASSERT_LE(kept->count, static_cast<uint32_t>(ALE_KEPT_SCANS));
    }
    EXPECT_GE(kept->count, static_cast<uint32_t>(ALE_KEPT_SCANS / 2));
    EXPECT_EQ(kept->scan[0].number, 0u);
    EXPECT_GT(kept->scan[kept->count - 1].number, static_cast<uint32_t>(last - 40));
    for (uint32_t k = 1; k < kept->count; k++) {
        ASSERT_GT(kept->scan[k].number, kept->scan[k - 1].number);
        EXPECT_LE(kept->scan[k].number - kept->scan[k - 1].number, 33u) << k;
    }
}
