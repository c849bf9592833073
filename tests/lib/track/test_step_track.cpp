// lib/track/step_track.c: a robot that stands among people who walk, one whose wheels slip, and one
// between bare walls.
#include <functional>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/keyframe.h"
#include "track/pipeline_state.h"
}

namespace
{

/* People about a robot that stands: each a body of 0.4 m that goes from place to place. */
class People
{
  public:
    People(const Eigen::Vector2d &robot, int count, std::mt19937 &rng) : robot_(robot), rng_(rng)
    {
        for (int k = 0; k < count; k++) {
            people_.push_back({somewhere(), somewhere(), 0.3 + unit_(rng_)});
        }
    }

    /* A tenth of a second. */
    void walk()
    {
        for (Person &p : people_) {
            const Eigen::Vector2d way = p.to - p.at;
            const Eigen::Vector2d next = p.at + way.normalized() * std::min(0.1 * p.speed, way.norm());
            const bool blocked = (next - robot_).norm() < 0.5 || way.norm() < 0.05;
            p.to = blocked ? somewhere() : p.to;
            p.at = blocked ? p.at : next;
        }
    }

    std::vector<room::Wall> in(std::vector<room::Wall> walls) const
    {
        for (const Person &p : people_) {
            for (int i = 0; i < 10; i++) {
                const double a = i * reference::pi / 5;
                const double b = a + reference::pi / 5;
                walls.push_back({p.at[0] + 0.2 * std::cos(a), p.at[1] + 0.2 * std::sin(a),
                                 p.at[0] + 0.2 * std::cos(b), p.at[1] + 0.2 * std::sin(b)});
            }
        }
        return walls;
    }

  private:
    struct Person {
        Eigen::Vector2d at, to;
        double speed;
    };

    Eigen::Vector2d somewhere()
    {
        Eigen::Vector2d p = robot_;
        while ((p - robot_).norm() < 0.6) {
            const double x = -0.6 + 2.7 * unit_(rng_);
            p = {x, -1.6 + 4.1 * unit_(rng_)};
        }
        return p;
    }

    Eigen::Vector2d robot_;
    std::mt19937 &rng_;
    std::uniform_real_distribution<double> unit_{0, 1};
    std::vector<Person> people_;
};

double from_nearest_wall(const Eigen::Vector2d &p)
{
    double nearest = 9;
    for (const room::Wall &w : room::l_shape()) {
        const Eigen::Vector2d from(w.x1, w.y1);
        const Eigen::Vector2d along = Eigen::Vector2d(w.x2, w.y2) - from;
        const double u = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - from - u * along).norm());
    }
    return nearest;
}

TEST(PipelineTrack, AtRestAmongWalkingPeopleItStaysAndTheirBodiesAreNoWalls)
{
    std::mt19937 rng(3);
    const reference::Pose robot(1, 0, 0.4);
    People people(robot.head<2>(), 4, rng);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    for (int k = 0; k < 900; k++) {
        const double t = 1 + 0.1 * k;
        const ale_odometry_t still = {std::llround(t * 1e6), {0, 0, 0}};
        people.walk();
        ale_pipeline_odometry(p.get(), &still);
        const ale_scan_t scan = room::scan_at(
            people.in(room::l_shape()), sensor, [&](double) { return robot; }, t, rng);
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
        EXPECT_LT(from_nearest_wall(middle.head<2>()), 0.05) << "line " << i;
    }
}

/* It drives into something, climbs up, and one wheel spins in the air: 4 rad/s are counted, none is turned.
 * How far off the robot is then. */
reference::Pose error_after_spinning(unsigned seed)
{
    const double drives_s = 2.5;
    const auto path = [&](double t) { return reference::Pose(0.4 * std::min(t, drives_s), 0, 0); };
    std::mt19937 rng(seed);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    for (int k = 0; k < 35; k++) {
        const double t = 0.1 * k;
        const double spun_rad = -4 * std::max(t - drives_s, 0.0);
        const reference::Pose counted(0.4 * std::min(t, drives_s), 0, spun_rad);
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(counted)};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        EXPECT_NE(e.state, ALE_STATE_LOST) << t;
    }
    const reference::Pose truth = room::since_start(path(0), path(drives_s));
    return reference::compose(reference::inverse(truth), convert::pose(e.map));
}

TEST(PipelineTrack, AWheelThatSpinsTurnsTheRobotInNoMap)
{
    for (unsigned seed = 1; seed <= 8; seed++) {
        const reference::Pose error = error_after_spinning(seed);
        EXPECT_LT(error.head<2>().norm(), 0.02) << "seed " << seed;
        EXPECT_LT(std::abs(error[2]), 0.01) << "seed " << seed;
    }
}

/* It drives in a circle, and for less than half a second its wheels slide: they count the turn, but nothing
 * of the way, 30 mm a scan, which is many of their sigmas and little beside what the scanner sees. How far
 * off the robot is a second later. */
reference::Pose error_after_sliding(unsigned seed)
{
    const double slides_s = 7;
    const double lasts_s = 0.4;
    const double speed = 0.3;
    const auto path = [](double t) {
        const double turned = 0.8 * std::max(t - 1, 0.0);
        return reference::Pose(0.3 * std::sin(turned), 0.3 * (1 - std::cos(turned)), turned);
    };
    std::mt19937 rng(seed);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.01;
    ale_estimate_t e = {};
    double t = 0;
    for (int k = 0; k < 85; k++) {
        t = 0.1 * k;
        const double missed = speed * std::clamp(t - slides_s, 0.0, lasts_s);
        const reference::Pose counted = reference::compose(path(t), reference::Pose(-missed, 0, 0));
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(counted)};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
    }
    const reference::Pose truth = room::since_start(path(0), path(t));
    return reference::compose(reference::inverse(truth), convert::pose(e.map));
}

TEST(PipelineTrack, WheelsThatSlideForAMomentDoNotDragTheRobotAlong)
{
    for (unsigned seed = 1; seed <= 8; seed++) {
        EXPECT_LT(error_after_sliding(seed).head<2>().norm(), 0.03) << "seed " << seed;
    }
}

/* The wheels count nothing for a while, then all of it at once. The scan tells how far off the robot is. */
void drive_with_stalled_wheels(unsigned seed, double stalled_s)
{
    const double stalls_s = 4;
    std::mt19937 rng(seed);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    for (int k = 0; k < 80; k++) {
        const double t = 0.1 * k;
        const bool stalls = t > stalls_s && t < stalls_s + stalled_s;
        const ale_odometry_t wheels = {std::llround(t * 1e6),
                                       convert::pose(room::path(stalls ? stalls_s : t))};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose truth = room::since_start(room::path(0), room::path(t));
        const reference::Pose off = reference::compose(reference::inverse(truth), convert::pose(e.map));
        if (e.state == ALE_STATE_GOOD) {
            EXPECT_LT(off.head<2>().norm(), 0.10) << "seed " << seed << " at " << t;
            EXPECT_LT(std::abs(off[2]), 0.05) << "seed " << seed << " at " << t;
        }
    }
    EXPECT_EQ(e.state, ALE_STATE_GOOD) << "seed " << seed;
    EXPECT_EQ(e.maps, 1) << "seed " << seed;
}

TEST(PipelineTrack, WheelsThatStallAndThenTellAllAtOnceNeverHoldAGoodPoseAgainstScans)
{
    for (unsigned seed = 1; seed <= 6; seed++) {
        drive_with_stalled_wheels(seed, 0.5 + 0.25 * seed);
    }
}

/* It looks ahead only, and turns in three seconds without scans to what it has not seen; the wheels, which
 * have told of a way before, tell nothing of that. They may be late for the first scans; the fourth begins a
 * map, and those before are tied to it. */
TEST(PipelineTrack, AfterAGapTheFourthScanThatNothingExplainsBeginsAMap)
{
    for (unsigned seed = 1; seed <= 6; seed++) {
        const uint32_t first_after = 30;
        const uint32_t fourth = first_after + 3;
        const auto keyframe = std::make_unique<ale_keyframe_t>();
        const room::Pipeline p = room::make(ale_pipeline_default_config());
        std::mt19937 rng(seed);
        room::Sensor sensor;
        sensor.noise = 0.004;
        for (uint32_t k = 0; k <= fourth; k++) {
            const double t = 0.1 * k + (k >= first_after ? 3 : 0);
            const auto path = [&](double) { return reference::Pose(1, 0, k < first_after ? 0 : 1.3); };
            const ale_odometry_t still = {std::llround(t * 1e6), {k == 0 ? -1000 : 0, 0, 0}};
            ale_pipeline_odometry(p.get(), &still);
            ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
            for (int beam = 0; beam < scan.beams; beam++) {
                const bool ahead = std::abs(beam - scan.beams / 2) < scan.beams / 5;
                scan.flag[beam] = ahead ? scan.flag[beam] : static_cast<uint8_t>(ALE_BEAM_BLIND);
            }
            ale_estimate_t e = {};
            ale_pipeline_scan(p.get(), &scan, &e);
            ale_pipeline_keyframe(p.get(), keyframe.get());
            EXPECT_EQ(e.map_id, k == fourth ? 1U : 0U) << "seed " << seed << " scan " << k;
            EXPECT_EQ(e.state == ALE_STATE_GOOD, k < first_after) << "seed " << seed << " scan " << k;
        }
        EXPECT_EQ(keyframe->scan, fourth);
        EXPECT_TRUE(keyframe->broken);
        EXPECT_EQ(keyframe->tied_from, first_after);
    }
}

/* The wheel spins slowly in a bend, while all but a few beams are covered for a quarter of a second. How far
 * off the heading is in the end. */
double turned_by_spinning_unseen(unsigned seed)
{
    const double drives_s = 2.5;
    const double covered_s = 0.25;
    const auto path = [&](double t) { return room::bend(t, drives_s); };
    std::mt19937 rng(seed);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    for (int k = 0; k < 40; k++) {
        const double t = 0.1 * k;
        const double since_s = t - drives_s;
        reference::Pose counted = path(t);
        counted[2] += 0.9 * std::clamp(since_s, 0.0, covered_s);
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(counted)};
        ale_pipeline_odometry(p.get(), &wheels);
        ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
        for (int beam = 0; since_s > 0 && since_s < covered_s && beam < scan.beams; beam++) {
            if (std::abs(beam - 300) > 5) {
                scan.flag[beam] = ALE_BEAM_NO_RETURN;
            }
        }
        ale_pipeline_scan(p.get(), &scan, &e);
    }
    const reference::Pose truth = room::since_start(path(0), path(drives_s));
    return reference::compose(reference::inverse(truth), convert::pose(e.map))[2];
}

TEST(PipelineTrack, AWheelThatSpinsUnseenTurnsTheRobotInNoMap)
{
    for (unsigned seed = 1; seed <= 6; seed++) {
        EXPECT_LT(std::abs(turned_by_spinning_unseen(seed)), 0.02) << "seed " << seed;
    }
}

/* Scans three seconds apart, on a robot that turns and whose wheels err; in the end the map holds nothing of
 * what is seen. */
TEST(PipelineTrack, WhatTheMapDoesNotHoldTheLastScanTells)
{
    double sum_rad = 0;
    for (unsigned seed = 1; seed <= 8; seed++) {
        std::mt19937 rng(seed);
        std::normal_distribution<double> normal(0, 0.06);
        const room::Pipeline p = room::make(ale_pipeline_default_config());
        double turned = 0;
        const auto path = [&](double) { return reference::Pose(0, 0, turned); };
        double counted = 0;
        room::Sensor sensor;
        sensor.noise = 0.004;
        sensor.beam_time_ns = 0;
        ale_estimate_t e = {};
        for (int k = 0; k < 20; k++) {
            const bool last = k == 19;
            if (last) {
                ale_local_map_clear(&p->map);
            }
            turned += 0.3;
            counted += 0.3 + (last ? 0.12 : normal(rng));
            const ale_odometry_t wheels = {k * 3000000, convert::pose(reference::Pose(0, 0, counted))};
            ale_pipeline_odometry(p.get(), &wheels);
            const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, 3.0 * k, rng);
            ale_pipeline_scan(p.get(), &scan, &e);
        }
        const double error = convert::pose(e.map)[2] - (turned - 0.3);
        sum_rad += std::abs(std::remainder(error, 2 * reference::pi));
        EXPECT_LT(convert::pose(e.map).head<2>().norm(), 0.05) << "seed " << seed;
        EXPECT_NE(e.state, ALE_STATE_LOST);
    }
    EXPECT_LT(sum_rad / 8, 0.03);
}

// Two walls, 2 m apart and without an end as far as the scanner reaches.
std::vector<room::Wall> bare_corridor()
{
    return {{-50, -1, 50, -1}, {-50, 1, 50, 1}};
}

// The same with shallow recesses up to some place, as doors make them.
std::vector<room::Wall> corridor_of_doors(double end = 24, double every_m = 3)
{
    std::vector<room::Wall> walls = {{end - 2, -1, 50, -1}, {end - 0.5, 1, 50, 1}};
    for (double x = -12; x < end; x += every_m) {
        for (const double side : {-1.0, 1.0}) {
            const double from = x + (side > 0 ? every_m / 2 : 0);
            const double depth = side * 1.2;
            walls.push_back({from + 1 - every_m, side, from, side});
            walls.push_back({from, side, from, depth});
            walls.push_back({from, depth, from + 1, depth});
            walls.push_back({from + 1, depth, from + 1, side});
        }
    }
    return walls;
}

reference::Pose along_corridor(double t)
{
    return {0.5 * t, 0.01 * std::sin(0.5 * t), 0.01 * std::cos(0.5 * t)};
}

// What wheels count that tell every way by a part too long or too short.
std::function<reference::Pose(double)> wheels_that_count(double per_metre)
{
    return [per_metre](double t) -> reference::Pose {
        const reference::Pose p = room::since_start(along_corridor(0), along_corridor(t));
        return {per_metre * p[0], per_metre * p[1], p[2]};
    };
}

const std::function<reference::Pose(double)> no_wheels;

// A drive along a corridor. Wheels are told as they come or, where scans are stamped late, with each of them.
struct CorridorDrive {
    std::vector<ale_estimate_t> estimates;
    std::vector<double> way;

    CorridorDrive(const std::vector<room::Wall> &corridor,
                  const std::function<reference::Pose(double)> &wheels, unsigned seed = 7,
                  const std::vector<double> &late_s = {})
    {
        ale_pipeline_config_t config = ale_pipeline_default_config();
        config.use_odometry = wheels != nullptr;
        const room::Pipeline pipeline = room::make(config);
        std::mt19937 rng(seed);
        room::Sensor sensor;
        sensor.noise = 0.01;
        const size_t scans = late_s.empty() ? 120 : late_s.size();
        for (size_t k = 0; k < scans; k++) {
            const double t = 1 + 0.1 * static_cast<double>(k);
            ale_scan_t scan = room::scan_at(corridor, sensor, along_corridor, t, rng);
            const auto tell = [&](int64_t stamp_us, double at) {
                const ale_odometry_t sample = {stamp_us, convert::pose(wheels(at))};
                ale_pipeline_odometry(pipeline.get(), &sample);
            };
            if (!late_s.empty()) {
                scan.stamp_us = std::llround((t + late_s[k]) * 1e6);
                tell(scan.stamp_us, t);
            } else if (wheels) {
                for (int i = 0; i < 10; i++) {
                    const double at = t - 0.04 + 0.01 * i;
                    tell(std::llround(at * 1e6), at);
                }
            }
            ale_estimate_t e;
            ale_pipeline_scan(pipeline.get(), &scan, &e);
            estimates.push_back(e);
            way.push_back(along_corridor(t)[0] - along_corridor(1)[0]);
        }
    }

    double sigma_m(size_t k) const
    {
        return std::sqrt(static_cast<double>(estimates[k].cov[0])) * 1e-6;
    }

    double error_m(size_t k) const
    {
        return std::abs(estimates[k].map.x_um * 1e-6 - way[k]);
    }
};

TEST(PipelineTrack, BetweenBareWallsNoScanIsCalledGoodAndTheVarianceAlongThemGrows)
{
    for (const bool counted : {true, false}) {
        const CorridorDrive drive(bare_corridor(), counted ? wheels_that_count(1.03) : no_wheels);
        for (size_t k = 3; k < drive.estimates.size(); k++) {
            ASSERT_EQ(drive.estimates[k].state, ALE_STATE_WEAK) << k << " wheels " << counted;
            ASSERT_LT(std::min(drive.error_m(k), 2.5), 3 * drive.sigma_m(k)) << k << " wheels " << counted;
        }
        EXPECT_GT(drive.sigma_m(119), 0.1);
        EXPECT_LT(std::sqrt(static_cast<double>(drive.estimates[119].cov[4])) * 1e-6, 0.05) << "across";
    }
}

/* The far ends of the walls go along with the robot, and would stop it. */
TEST(PipelineTrack, WithoutWheelsItGoesOnAsItDidWhereNothingHoldsIt)
{
    const unsigned seeds = 12;
    double sum_m = 0;
    for (unsigned seed = 1; seed <= seeds; seed++) {
        const CorridorDrive drive(corridor_of_doors(3), no_wheels, seed);
        EXPECT_EQ(drive.estimates[119].state, ALE_STATE_WEAK) << seed;
        EXPECT_LT(drive.error_m(119), drive.sigma_m(119)) << seed;
        EXPECT_LT(drive.error_m(60), 0.12) << seed;
        sum_m += drive.error_m(119);
    }
    EXPECT_LT(sum_m / seeds, 0.2);
}

/* Recesses hold the robot, but new ones are seen from where wrong wheels have put it. */
TEST(PipelineTrack, WhatAWrongScaleOfTheWheelsDoesAlongACorridorIsInItsCovariance)
{
    for (const double counted : {0.95, 1.05}) {
        const CorridorDrive drive(corridor_of_doors(), wheels_that_count(counted));
        double squares = 0;
        for (size_t k = 3; k < drive.estimates.size(); k++) {
            squares += std::pow(drive.error_m(k) / drive.sigma_m(k), 2);
        }
        const double mean = squares / static_cast<double>(drive.estimates.size() - 3);
        EXPECT_LT(mean, 4) << "wheels count " << counted;
        EXPECT_GT(drive.error_m(119), 0.002);
    }
}

/* Doors tell how far it has come, but they are a small part of what is seen: a scan that is put where wheels
 * of a wrong sign lead finds all but doors there. */
TEST(PipelineTrack, WheelsThatTellAheadAsBackInACorridorAreRefutedByItsDoors)
{
    const auto wheels = [](double t) { return wheels_that_count(1)(t - 2 * std::clamp(t - 5, 0.0, 2.0)); };
    for (unsigned seed = 1; seed <= 4; seed++) {
        for (const double every_m : {4.0, 6.0}) {
            const CorridorDrive drive(corridor_of_doors(24, every_m), wheels, seed);
            for (size_t k = 3; k < drive.estimates.size(); k++) {
                ASSERT_LT(drive.error_m(k), 0.1) << k << " seed " << seed << " doors every " << every_m;
            }
        }
    }
}

// By how much scans are stamped late that a queue lets go many at once, some after later ones.
std::vector<double> held_up(size_t scans, unsigned seed)
{
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<double> late_s;
    double lets_go = 0;
    for (size_t k = 0; k < scans; k++) {
        const double taken = 0.1 * static_cast<double>(k);
        lets_go = taken > lets_go ? taken + 0.5 * chance(rng) : lets_go;
        late_s.push_back(lets_go - taken + (chance(rng) < 0.1 ? 0.25 * chance(rng) : 0));
    }
    return late_s;
}

/* Between bare walls wheels alone tell how far the robot has come: what is told with a scan is of its
 * instant, whenever it was stamped. */
TEST(PipelineTrack, WheelsThatAreToldWithScansKeepTheWayHoweverLateBothAreStamped)
{
    for (unsigned seed = 1; seed <= 4; seed++) {
        const CorridorDrive drive(bare_corridor(), wheels_that_count(1), seed, held_up(500, seed));
        const size_t end = drive.estimates.size() - 1;
        for (size_t k = 300; k <= end; k++) {
            const double gone_m = drive.estimates[k].map.x_um * 1e-6 - drive.estimates[k - 1].map.x_um * 1e-6;
            ASSERT_NEAR(gone_m, 0.05, 0.015) << k << " seed " << seed;
            ASSERT_EQ(drive.estimates[k].wheel_fault, ALE_WHEELS_FINE) << k << " seed " << seed;
        }
        EXPECT_NEAR(drive.error_m(end), drive.error_m(300), 0.1) << seed;
    }
}

} // namespace
