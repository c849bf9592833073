// lib/track/pipeline.c: a whole drive in a made room, with every kind of mishap.
#include <cstring>

#include <gtest/gtest.h>

#include "room.h"

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
        wheels = reference::compose(wheels, step);
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
 * most of what comes into view is new. Some stamps are wrong by a fifth of a second. */
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
    reference::Pose wheels(0, 0, 0);
    double worst_m = 0;
    for (int k = 0; k < 120; k++) {
        const reference::Pose step = room::since_start(path(k - 1), path(k));
        const double way = step.head<2>().norm();
        wheels = reference::compose(wheels, step + way * reference::Pose(0.04, 0.02, 0.03) * normal(rng));
        ale_scan_t scan = room::scan_at(walls, sensor, path, k, rng);
        scan.stamp_us += k % 7 == 6 ? -1200000 : 0;
        const ale_odometry_t sample = {scan.stamp_us, convert::pose(wheels)};
        ale_pipeline_odometry(p.get(), &sample);
        ale_estimate_t e;
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose truth = room::since_start(path(0), path(k));
        worst_m = std::max(worst_m, (convert::pose(e.map) - truth).head<2>().norm());
        ASSERT_NE(e.state, ALE_STATE_LOST) << k;
    }
    EXPECT_LT(worst_m, 0.10);
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

/* Metres ahead after two seconds by wheels alone that count 0.4 m/s. */
double ahead_by_wheels(int32_t distance_factor_ppm)
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
    return convert::pose(e.map)[0];
}

TEST(Pipeline, AKnownErrorOfTheWheelsIsTakenOff)
{
    EXPECT_NEAR(ahead_by_wheels(1250000) / ahead_by_wheels(1000000), 1.25, 0.01);
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

TEST(Pipeline, CarriedAwayItSaysLostAndFindsItselfInTheMap)
{
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.use_odometry = false;
    const room::Pipeline p = room::make(config);
    std::mt19937 rng(5);
    room::Sensor sensor;
    sensor.noise = 0.003;
    ale_estimate_t e;
    double t = 1;
    for (int k = 0; k < 180; k++, t += 0.1) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
    }
    const reference::Pose there = reference::compose(room::path(t), {0.9, -0.7, 2.2});
    auto standing = [&](double) { return there; };
    bool lost = false;
    double longest = 0;
    for (int k = 0; k < 120; k++, t += 0.1) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, standing, t, rng);
        const ale_pose_t before = e.smooth;
        ale_pipeline_scan(p.get(), &scan, &e);
        lost = lost || e.state == ALE_STATE_LOST;
        longest = std::max(
            longest, room::since_start(convert::pose(before), convert::pose(e.smooth)).head<2>().norm());
    }
    const reference::Pose truth = room::since_start(room::path(1), there);
    EXPECT_TRUE(lost);
    EXPECT_EQ(e.state, ALE_STATE_GOOD);
    EXPECT_LT((convert::pose(e.map) - truth).head<2>().norm(), 0.03);
    EXPECT_LT(std::abs(reference::wrap(convert::pose(e.map)[2] - truth[2])), 0.02);
    EXPECT_LT(longest, 0.6);
}

/* Carried to another place between two scans, whichever it is: it never says good while it is wrong. */
TEST(Pipeline, CarriedAnywhereItIsNeverWrongWhileItSaysGood)
{
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int found = 0;
    for (int trial = 0; trial < 8; trial++) {
        ale_pipeline_config_t config = ale_pipeline_default_config();
        config.use_odometry = trial % 2;
        const room::Pipeline p = room::make(config);
        room::Sensor sensor;
        sensor.noise = 0.004;
        const double carried = 19.05; /* between two sweeps */
        const reference::Pose there =
            reference::compose(room::path(1 + 17 * unit(rng)),
                               {0.6 * unit(rng) - 0.3, 0.6 * unit(rng) - 0.3, 2 * reference::pi * unit(rng)});
        const reference::Pose hands = room::since_start(room::path(carried), there);
        if (hands.head<2>().norm() < 0.5) {
            continue;
        }
        auto path = [&](double t) {
            return t < carried ? room::path(t)
                               : reference::compose(there, {0, 0, 0.3 * std::sin(t - carried)});
        };
        reference::Pose wheels(0, 0, 0);
        ale_estimate_t e = {};
        for (int k = 0; k < 260; k++) {
            const double t = 1 + 0.1 * k;
            const bool lifted = t - 0.1 < carried && t >= carried;
            wheels = lifted ? wheels : reference::compose(wheels, room::since_start(path(t - 0.1), path(t)));
            const ale_odometry_t sample = {std::llround(t * 1e6), convert::pose(wheels)};
            ale_pipeline_odometry(p.get(), &sample);
            const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
            ale_pipeline_scan(p.get(), &scan, &e);
            const reference::Pose error =
                room::since_start(convert::pose(e.map), room::since_start(path(1), path(t)));
            const bool wrong = error.head<2>().norm() > 0.3 || std::abs(reference::wrap(error[2])) > 0.2;
            ASSERT_FALSE(wrong && e.state == ALE_STATE_GOOD) << "trial " << trial << " scan " << k;
        }
        found += e.state == ALE_STATE_GOOD;
    }
    EXPECT_GE(found, 5);
}

/* People walk about a robot that stands still: each a body of 0.4 m that goes from place to place and rests.
 */
TEST(Pipeline, AtRestAmongWalkingPeopleItStaysAndTheirBodiesAreNoWalls)
{
    struct Person {
        Eigen::Vector2d at, to;
        double speed;
    };
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> unit(0, 1);
    const reference::Pose robot(1, 0, 0.4);
    const Eigen::Vector2d place = robot.head<2>();
    const auto somewhere = [&] {
        Eigen::Vector2d p = place;
        while ((p - place).norm() < 0.6) {
            p = {-0.6 + 2.7 * unit(rng), -1.6 + 4.1 * unit(rng)};
        }
        return p;
    };
    std::vector<Person> people;
    for (int k = 0; k < 4; k++) {
        people.push_back({somewhere(), somewhere(), 0.3 + unit(rng)});
    }
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    for (int k = 0; k < 900; k++) {
        std::vector<room::Wall> walls = room::l_shape();
        for (Person &q : people) {
            const Eigen::Vector2d way = q.to - q.at;
            const Eigen::Vector2d next = q.at + way.normalized() * std::min(0.1 * q.speed, way.norm());
            const bool blocked = (next - place).norm() < 0.5 || way.norm() < 0.05;
            q.to = blocked ? somewhere() : q.to;
            q.at = blocked ? q.at : next;
            for (int i = 0; i < 10; i++) {
                const double a = i * reference::pi / 5;
                const double b = a + reference::pi / 5;
                walls.push_back({q.at[0] + 0.2 * std::cos(a), q.at[1] + 0.2 * std::sin(a),
                                 q.at[0] + 0.2 * std::cos(b), q.at[1] + 0.2 * std::sin(b)});
            }
        }
        const double t = 1 + 0.1 * k;
        const ale_odometry_t still = {std::llround(t * 1e6), {0, 0, 0}};
        ale_pipeline_odometry(p.get(), &still);
        const ale_scan_t scan = room::scan_at(
            walls, sensor, [&](double) { return robot; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        ASSERT_NE(e.state, ALE_STATE_LOST) << k;
    }
    EXPECT_EQ(e.state, ALE_STATE_GOOD);
    EXPECT_LT(convert::pose(e.map).head<2>().norm(), 0.010);
    const auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(p.get(), map.get());
    for (int i = 0; i < map->line_count; i++) {
        const ale_map_line_t &line = map->line[i];
        const reference::Pose a = convert::pose(ale_pose_t{line.start.x_um, line.start.y_um, 0});
        const reference::Pose b = convert::pose(ale_pose_t{line.end.x_um, line.end.y_um, 0});
        const reference::Pose middle = reference::compose(robot, (a + b) / 2);
        double nearest = 9;
        for (const room::Wall &w : room::l_shape()) {
            const Eigen::Vector2d from(w.x1, w.y1);
            const Eigen::Vector2d along = Eigen::Vector2d(w.x2, w.y2) - from;
            const double u = std::clamp((middle.head<2>() - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
            nearest = std::min(nearest, (middle.head<2>() - from - u * along).norm());
        }
        EXPECT_LT(nearest, 0.05) << "line " << i;
    }
}

TEST(Pipeline, StartsInALoadedMapWhereverItStands)
{
    std::mt19937 rng(6);
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.use_odometry = false;
    const room::Pipeline first = room::make(config);
    ale_estimate_t e;
    for (int k = 0; k < 180; k++) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, 1 + 0.1 * k, rng);
        ale_pipeline_scan(first.get(), &scan, &e);
    }
    const auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(first.get(), map.get());
    EXPECT_GE(map->line_count, 8);
    EXPECT_LE(map->line_count, 20);
    EXPECT_GE(map->corner_count, 4);
    const room::Pipeline second = room::make(config);
    ale_pipeline_load_map(second.get(), map.get(), {0, 0, 0}, false);
    for (int k = 0; k < 100; k++) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, 9 + 0.1 * k, rng);
        ale_pipeline_scan(second.get(), &scan, &e);
        EXPECT_TRUE(k > 0 || e.state != ALE_STATE_GOOD);
    }
    const reference::Pose truth = room::since_start(room::path(1), room::path(18.9));
    EXPECT_LT((convert::pose(e.map) - truth).head<2>().norm(), 0.03);
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
        scan.step_bam = rng() % 2 ? 4194304 : -3000000;
        scan.first_bearing_bam = static_cast<uint32_t>(rng());
        scan.range_min_um = 20000;
        scan.range_max_um = 80000000;
        for (uint16_t i = 0; i < scan.beams; i++) {
            ale_scan_set_range(&scan, i, static_cast<int32_t>(rng() % 80000000));
        }
        const ale_odometry_t o = {stamp,
                                  {static_cast<int32_t>(rng() % 100000), 0, static_cast<uint32_t>(rng())}};
        ale_pipeline_odometry(p.get(), &o);
        ale_pipeline_scan(p.get(), &scan, &e);
        for (int i = 0; i < 9; i += 4) {
            ASSERT_GE(e.cov[i], 0);
        }
    }
}
