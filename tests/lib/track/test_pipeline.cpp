// lib/track/pipeline.c: a whole drive in a made room, with every kind of mishap.
#include <cstring>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/keyframe.h"
}

namespace
{
struct Result {
    double worst_m = 0;
    double worst_rad = 0;
    double nees = 0;
    double longest_step_m = 0;
    ale_estimate_t last = {};
    std::vector<ale_estimate_t> all;
};

struct Drive {
    bool odometry = true;
    double lag_s = 0;
    double scale = 1;
    double noise = 0.004;
    int scans = 250;
    room::Sensor sensor;
    bool mirrored = false;
    bool frozen = false; /* wheels tell one pose for ever */
};

Result run(const Drive &d)
{
    std::mt19937 rng(11);
    std::normal_distribution<double> normal;
    std::vector<room::Wall> walls = room::l_shape();
    auto path = [&](double t) {
        const reference::Pose p = room::path(t);
        return d.mirrored ? reference::Pose(p[0], -p[1], -p[2]) : p;
    };
    if (d.mirrored) {
        for (room::Wall &w : walls) {
            w = {w.x1, -w.y1, w.x2, -w.y2};
        }
    }
    room::Sensor sensor = d.sensor;
    sensor.noise = d.noise;
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.sensor = convert::pose(sensor.mounting);
    config.use_odometry = d.odometry;
    const room::Pipeline p = room::make(config);
    Result r;
    reference::Pose wheels(0, 0, 0);
    for (int k = 0; k < d.scans; k++) {
        const double t = 1 + 0.1 * k;
        reference::Pose step = room::since_start(path(t + d.lag_s - 0.1), path(t + d.lag_s));
        step.head<2>() *= d.scale;
        step[2] += 0.004 * normal(rng);
        wheels = d.frozen ? wheels : reference::compose(wheels, step);
        const ale_odometry_t sample = {std::llround(t * 1e6), convert::pose(wheels)};
        ale_pipeline_odometry(p.get(), &sample);
        const ale_scan_t scan = room::scan_at(walls, sensor, path, t, rng);
        const ale_pose_t before = r.last.smooth;
        ale_pipeline_scan(p.get(), &scan, &r.last);
        r.all.push_back(r.last);
        const reference::Pose truth = room::since_start(path(1), path(t));
        const reference::Pose got = convert::pose(r.last.map);
        const double heading = reference::wrap(got[2] - truth[2]);
        r.worst_m = std::max(r.worst_m, (got - truth).head<2>().norm());
        r.worst_rad = std::max(r.worst_rad, std::abs(heading));
        if (k > 0) {
            const reference::Pose way =
                room::since_start(convert::pose(before), convert::pose(r.last.smooth));
            r.longest_step_m = std::max(r.longest_step_m, way.head<2>().norm());
            Eigen::Matrix3d cov;
            for (int i = 0; i < 9; i++) {
                const double unit = (i / 3 == 2 ? 1e-9 : 1e-6) * (i % 3 == 2 ? 1e-9 : 1e-6);
                cov(i / 3, i % 3) = static_cast<double>(r.last.cov[i]) * unit;
            }
            const Eigen::Vector3d e(got[0] - truth[0], got[1] - truth[1], heading);
            r.nees += e.dot(cov.ldlt().solve(e)) / (d.scans - 1);
        }
    }
    return r;
}
} // namespace

TEST(Pipeline, FollowsTheRobotWithinACentimetreWithAndWithoutOdometry)
{
    for (bool odometry : {true, false}) {
        Drive d;
        d.odometry = odometry;
        const Result r = run(d);
        EXPECT_LT(r.worst_m, 0.010) << odometry;
        EXPECT_LT(r.worst_rad, 0.005) << odometry;
        EXPECT_LT(r.nees, 9) << odometry;
        EXPECT_EQ(r.last.state, ALE_STATE_GOOD);
        EXPECT_LT(r.longest_step_m, 0.08);
    }
}

/* As an encoder that is not connected. Nothing holds the robot back once scans have shown that it goes, and
 * it is said. */
TEST(Pipeline, WheelsThatNeverMoveSayNothing)
{
    Drive d;
    d.frozen = true;
    const Result r = run(d);
    EXPECT_LT(r.worst_m, 0.05);
    EXPECT_EQ(r.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(r.last.wheel_fault, ALE_WHEELS_STALLED);
}

TEST(Pipeline, FindsTheLagAndTheScaleOfTheWheels)
{
    Drive d;
    d.lag_s = 0.13;
    d.scale = 1.06;
    const Result r = run(d);
    EXPECT_NEAR(r.last.lag_us, 130000, 12000);
    EXPECT_LT(r.worst_m, 0.015);
}

TEST(Pipeline, TakesASensorThatIsMountedAheadAndTurned)
{
    Drive d;
    d.sensor.mounting = {0.15, -0.05, 0.6};
    const Result r = run(d);
    EXPECT_LT(r.worst_m, 0.012);
}

TEST(Pipeline, TakesWholeScansOfFewBeams)
{
    Drive d;
    d.sensor.beams = 361;
    d.sensor.first = -reference::pi / 2;
    d.sensor.step = reference::pi / 360;
    d.sensor.beam_time_ns = 0;
    const Result r = run(d);
    EXPECT_LT(r.worst_m, 0.02);
}

/* A scan a second of a scanner that looks ahead only, while the robot drives 0.6 m and turns up to 0.7 rad:
 * most of what comes into view is new. Some stamps are wrong by 1.2 s, some stand 10 ms behind the one
 * before: how fast the robot then was nobody knows, and it has not been put elsewhere. */
TEST(Pipeline, FollowsRareScansOfFewBeamsByTheWheelsThroughWhatItHasNeverSeen)
{
    std::mt19937 rng(21);
    std::normal_distribution<double> normal;
    std::vector<room::Wall> walls = room::l_shape();
    for (room::Wall &w : walls) { /* a hall of 18 m by 15 m */
        w = {3 * w.x1, 3 * w.y1, 3 * w.x2, 3 * w.y2};
    }
    const auto path = [](double t) {
        const reference::Pose p = room::path(t / 4 + 1);
        return reference::Pose(3 * p[0], 3 * p[1], p[2] + 0.9 * std::sin(0.7 * t));
    };
    room::Sensor sensor;
    sensor.beams = 180;
    sensor.first = -reference::pi / 2;
    sensor.step = reference::pi / 180;
    sensor.beam_time_ns = 0;
    sensor.noise = 0.01;
    sensor.reach = 40;
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const auto keyframe = std::make_unique<ale_keyframe_t>();
    reference::Pose wheels(0, 0, 0);
    double worst_m = 0;
    int keyframes = 0;
    for (int k = 0; k < 120; k++) {
        const reference::Pose step = room::since_start(path(k - 1), path(k));
        const double way = step.head<2>().norm();
        wheels = reference::compose(wheels, step + way * reference::Pose(0.04, 0.02, 0.03) * normal(rng));
        ale_scan_t scan = room::scan_at(walls, sensor, path, k, rng);
        scan.stamp_us += k % 7 == 6 ? -1200000 : (k % 7 == 3 ? -990000 : 0);
        const ale_odometry_t sample = {scan.stamp_us, convert::pose(wheels)};
        ale_pipeline_odometry(p.get(), &sample);
        ale_estimate_t e;
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose truth = room::since_start(path(0), path(k));
        worst_m = std::max(worst_m, (convert::pose(e.map) - truth).head<2>().norm());
        ASSERT_NE(e.state, ALE_STATE_LOST) << k;
        if (ale_pipeline_keyframe(p.get(), keyframe.get())) {
            EXPECT_FALSE(keyframe->broken) << k;
            keyframes++;
        }
    }
    EXPECT_LT(worst_m, 0.10);
    EXPECT_GT(keyframes, 50);
}

TEST(Pipeline, AMirroredWorldIsFollowedAsWell)
{
    Drive d;
    d.mirrored = true;
    EXPECT_LT(run(d).worst_m, 0.010);
}

TEST(Pipeline, TheSameCallsGiveTheSameBytes)
{
    Drive d;
    d.scans = 60;
    const Result a = run(d);
    const Result b = run(d);
    for (size_t k = 0; k < a.all.size(); k++) {
        ASSERT_EQ(std::memcmp(&a.all[k], &b.all[k], sizeof a.all[k]), 0) << k;
    }
}

TEST(Pipeline, AnswersEveryScanAlsoDroppedAndEmptyOnes)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(1);
    ale_estimate_t e;
    ale_pipeline_dropped(p.get(), 900000, &e);
    EXPECT_TRUE(e.predicted);
    EXPECT_EQ(e.scan, 0u);
    ale_scan_t nothing = {};
    nothing.stamp_us = 950000;
    ale_pipeline_scan(p.get(), &nothing, &e);
    EXPECT_EQ(e.scan, 1u);
    for (int k = 0; k < 40; k++) {
        const double t = 1 + 0.1 * k;
        const ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, t, rng);
        if (k % 4 == 3) {
            ale_pipeline_dropped(p.get(), scan.stamp_us, &e);
        } else {
            ale_pipeline_scan(p.get(), &scan, &e);
        }
        EXPECT_EQ(e.scan, static_cast<uint32_t>(k) + 2);
        EXPECT_EQ(e.predicted, k % 4 == 3);
        EXPECT_EQ(e.stamp_us, scan.stamp_us);
    }
    const reference::Pose truth = room::since_start(room::path(1), room::path(4.8));
    EXPECT_NEAR(convert::pose(e.map)[0], truth[0], 0.08);
}

/* After two seconds by wheels alone that count 0.4 m/s. */
ale_estimate_t by_wheels_alone(int32_t distance_factor_ppm)
{
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.odometry_distance_factor_ppm = distance_factor_ppm;
    const room::Pipeline p = room::make(config);
    std::mt19937 rng(1);
    ale_estimate_t e;
    const ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, 1, rng);
    for (int k = 0; k <= 20; k++) {
        const int64_t stamp_us = scan.stamp_us + 100000 * k;
        const ale_odometry_t sample = {stamp_us, {40000 * k, 0, 0}};
        ale_pipeline_odometry(p.get(), &sample);
        k == 0 ? ale_pipeline_scan(p.get(), &scan, &e) : ale_pipeline_dropped(p.get(), stamp_us, &e);
    }
    return e;
}

TEST(Pipeline, AKnownErrorOfTheWheelsIsTakenOff)
{
    const auto ahead = [](int32_t factor_ppm) { return convert::pose(by_wheels_alone(factor_ppm).map)[0]; };
    EXPECT_NEAR(ahead(1250000) / ahead(1000000), 1.25, 0.01);
}

/* The wheels' scale errs alike all the way: by 5 % of 0.8 m. */
TEST(Pipeline, WithoutScansTheErrorOfTheWheelsScaleGrowsWithTheWay)
{
    const ale_estimate_t e = by_wheels_alone(1000000);
    EXPECT_GT(std::sqrt(static_cast<double>(e.cov[0])), 0.05 * 800000);
}

TEST(Pipeline, WithoutScansTheCovarianceGrowsAndTheStateSaysSo)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(1);
    ale_estimate_t e;
    ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, 1, rng);
    ale_pipeline_scan(p.get(), &scan, &e);
    int64_t before = e.cov[0];
    for (int k = 1; k < 200; k++) {
        ale_pipeline_dropped(p.get(), 1000000 + 100000 * k, &e);
        EXPECT_GE(e.cov[0] + 1000, before) << k;
        before = e.cov[0];
    }
    EXPECT_EQ(e.state, ALE_STATE_LOST);
}

TEST(Pipeline, RefusesAConfigurationOutOfRangeAndChangesNothing)
{
    ale_pipeline_config_t bad = ale_pipeline_default_config();
    bad.max_speed_mm_s = 0;
    EXPECT_EQ(room::make(bad), nullptr);
    bad = ale_pipeline_default_config();
    bad.odometry_lag_us = 400000;
    EXPECT_EQ(room::make(bad), nullptr);
    bad = ale_pipeline_default_config();
    bad.odometry_turn_factor_ppm = 0;
    EXPECT_EQ(room::make(bad), nullptr);
    bad = ale_pipeline_default_config();
    bad.blind_count = ALE_MAX_BLIND_SECTORS + 1;
    EXPECT_EQ(room::make(bad), nullptr);
}

TEST(Pipeline, NoiseForScansAndJunkForStampsBreakNothing)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(8);
    ale_estimate_t e;
    int64_t stamp = 0;
    for (int k = 0; k < 400; k++) {
        ale_scan_t scan = {};
        scan.stamp_us = stamp;
        stamp += static_cast<int64_t>(rng() % 4000000) - 1000000;
        scan.beams = static_cast<uint16_t>(rng() % (ALE_MAX_BEAMS + 1));
        scan.beam_time_ns = rng() % 2 ? 97656 : 0;
        const int64_t whole_turn = INT64_C(0x100000000) / (scan.beams + 1);
        scan.step_bam = rng() % 2   ? 4194304
                        : rng() % 2 ? -3000000
                                    : static_cast<int32_t>(whole_turn & INT32_MAX);
        scan.first_bearing_bam = static_cast<uint32_t>(rng());
        scan.range_min_um = 20000;
        scan.range_max_um = 80000000;
        for (uint16_t i = 0; i < scan.beams; i++) {
            ale_scan_set_range(&scan, i, static_cast<int32_t>(rng() % 80000000));
            scan.bearing_bam[i] =
                scan.first_bearing_bam + i * static_cast<uint32_t>(scan.step_bam) + rng() % 5000000;
        }
        scan.own_bearings = k % 3 == 0;
        const ale_odometry_t o = {stamp,
                                  {static_cast<int32_t>(rng() % 100000), 0, static_cast<uint32_t>(rng())}};
        ale_pipeline_odometry(p.get(), &o);
        ale_pipeline_scan(p.get(), &scan, &e);
        for (int i = 0; i < 9; i += 4) {
            ASSERT_GE(e.cov[i], 0);
        }
    }
}
