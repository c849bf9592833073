// lib/track/step_recover.c: whether wheels have told of a way through a time that no scan watched.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/pipeline_state.h"
#include "track/step_predict.h"
#include "track/step_recover.h"
}

namespace
{

constexpr double begun = 10;   // s: the last scan before
constexpr double unseen = 4.1; // s, to the first one after

/* Whether a robot that stood, and whose wheels then tell of such a way (metres, by seconds since the last
 * scan; nothing: they are silent), has driven. */
template <typename Way> bool has_driven(const Way &way)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(1);
    const reference::Pose place(1, 0, 0.4);
    ale_estimate_t e = {};
    for (double t = begun - 3; t < begun + 0.01; t += 0.1) {
        const ale_odometry_t still = {std::llround(t * 1e6), {0, 0, 0}};
        ale_pipeline_odometry(p.get(), &still);
        const ale_scan_t scan = room::scan_at(
            room::l_shape(), room::Sensor(), [&](double) { return place; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
    }
    for (double t = 0.02; t < unseen + 0.01; t += 0.02) {
        if (const std::optional<double> m = way(t)) {
            const ale_odometry_t told = {std::llround((begun + t) * 1e6),
                                         {static_cast<int32_t>(std::llround(*m * 1e6)), 0, 0}};
            ale_pipeline_odometry(p.get(), &told);
        }
    }
    const ale_prediction_t prediction = ale_step_predict(p.get(), std::llround((begun + unseen) * 1e6));
    EXPECT_TRUE(prediction.counted);
    EXPECT_TRUE(ale_recover_is_unwatched(p.get(), &prediction));
    return ale_recover_has_driven(p.get(), &prediction);
}

TEST(StepRecover, WheelsThatCountThroughTheTimeHaveTold)
{
    EXPECT_TRUE(has_driven([](double t) -> std::optional<double> { return 0.15 * t; }));
}

TEST(StepRecover, WheelsThatWereSilentAndThenTellWhatTheyCountedHaveTold)
{
    EXPECT_TRUE(has_driven([](double t) -> std::optional<double> {
        return t > 0.05 && t < 4 ? std::nullopt : std::optional<double>(0.15 * t);
    }));
}

/* A robot at 2 m/s whose wheels are dead from just after the last scan until just before the next one. */
TEST(StepRecover, WhatTheyCountAtBothEndsOfTheTimeIsNoWayThroughIt)
{
    EXPECT_FALSE(has_driven([](double t) -> std::optional<double> {
        return 2 * (std::min(t, 0.1) + std::max(0.0, t - (unseen - 0.1)));
    }));
}

TEST(StepRecover, WheelsThatStandHaveToldOfNone)
{
    EXPECT_FALSE(has_driven([](double) -> std::optional<double> { return 0; }));
}

/* Stamps as of a busy computer, three at once: how fast the robot goes is not known from them. */
double crowded(int scan)
{
    return 0.6 * (scan / 3) + 0.001 * (scan % 3);
}

/* A robot that stands in the room for fifty scans; what its wheels tell before each of them. Returns how far
 * it is off in the end, m and rad together, or 1000 if it was ever lost. */
template <typename Told> double off_after(const Told &told)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(1);
    const reference::Pose place(1, 0, 0.4);
    ale_estimate_t e = {};
    bool lost = false;
    for (int k = 0; k < 50; k++) {
        const ale_odometry_t sample = {std::llround(crowded(k) * 1e6), told(k)};
        ale_pipeline_odometry(p.get(), &sample);
        const ale_scan_t scan = room::scan_at(
            room::l_shape(), room::Sensor(), [&](double) { return place; }, crowded(k), rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        lost = lost || e.state == ALE_STATE_LOST;
    }
    const double turned = std::abs(static_cast<int32_t>(e.map.theta_bam)) * 2 * reference::pi / 4294967296.0;
    return lost ? 1000 : std::hypot(e.map.x_um, e.map.y_um) * 1e-6 + turned;
}

TEST(StepRecover, WheelsThatTurnOnAndOnWhereTheRobotStandsAreNotFollowed)
{
    for (const double degrees : {-30.0, -21.0, 12.0, 30.0, 60.0}) {
        EXPECT_LT(off_after([&](int k) {
                      const double turn = std::clamp(k - 20, 0, 12) * degrees * reference::pi / 180;
                      return ale_pose_t{0, 0, convert::bam(turn)};
                  }),
                  0.03)
            << degrees << " degrees a scan";
    }
}

TEST(StepRecover, WheelsThatGoOnAndOnWhereTheRobotStandsAreNotFollowed)
{
    for (const int32_t step_um : {-300000, 150000, 400000}) {
        EXPECT_LT(off_after([&](int k) {
                      return ale_pose_t{std::clamp(k - 20, 0, 12) * step_um, 0, 0};
                  }),
                  0.03)
            << step_um << " um a scan";
    }
}

TEST(StepRecover, OneStepThatNoRobotCanGoMovesNothing)
{
    for (const double degrees : {-120.0, 70.0, 119.0}) {
        EXPECT_LT(
            off_after([&](int k) {
                const ale_pose_t jumped = {1060000, -960000, convert::bam(degrees * reference::pi / 180)};
                return k < 21 ? ale_pose_t{0, 0, 0} : jumped;
            }),
            0.03)
            << degrees << " degrees";
    }
}

/* A robot with a narrow view turns towards what no scan has shown; its wheels, once, jump on there. Returns
 * how far it is off in the end, as off_after(). */
double off_after_a_jump(double jumped_degrees, int at_scan)
{
    const double a_scan = 7 * reference::pi / 180;
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor narrow;
    narrow.beams = 342;
    narrow.first = -171 * narrow.step;
    narrow.beam_time_ns = 0;
    std::mt19937 rng(1);
    ale_estimate_t e = {};
    bool lost = false;
    double turned = 0;
    for (int k = 0; k < at_scan + 10; k++) {
        turned = std::max(0, k - 20) * a_scan;
        const bool has_jumped = k >= at_scan;
        const double told = turned + (has_jumped ? jumped_degrees * reference::pi / 180 : 0);
        const ale_odometry_t sample = {std::llround(crowded(k) * 1e6),
                                       {0, has_jumped ? -850000 : 0, convert::bam(told)}};
        ale_pipeline_odometry(p.get(), &sample);
        const reference::Pose place(1, 0, turned);
        const ale_scan_t scan = room::scan_at(
            room::l_shape(), narrow, [&](double) { return place; }, crowded(k), rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        lost = lost || e.state == ALE_STATE_LOST;
    }
    const double off = std::remainder(convert::radians(e.map.theta_bam) - turned, 2 * reference::pi);
    return lost ? 1000 : std::hypot(e.map.x_um, e.map.y_um) * 1e-6 + std::abs(off);
}

TEST(StepRecover, AJumpOfTheWheelsToWhatTheMapDoesNotHoldIsNotFollowed)
{
    for (const int scan : {22, 23, 24}) {
        for (const double degrees : {-70.0, 60.0, 90.0, 130.0}) {
            EXPECT_LT(off_after_a_jump(degrees, scan), 0.01) << degrees << " degrees before scan " << scan;
        }
    }
}

/* A corridor with a door recess on either side every four metres: half a turn about the middle of one lays it
 * on itself. */
std::vector<room::Wall> corridor_with_recesses()
{
    constexpr double apart = 4;
    std::vector<room::Wall> walls;
    for (double x = -apart; x < 15 * apart; x += apart) {
        for (const double side : {-1.0, 1.0}) {
            const double deep = 1.4 * side;
            walls.insert(walls.end(), {{x - 1.5, side, x + 1.5, side},
                                       {x + 1.5, side, x + 1.5, deep},
                                       {x + 1.5, deep, x + 2.5, deep},
                                       {x + 2.5, deep, x + 2.5, side}});
        }
    }
    return walls;
}

/* A scanner that looks ahead, half a turn and far, as those of such logs. */
room::Sensor looks_ahead()
{
    room::Sensor ahead;
    ahead.beams = 181;
    ahead.step = reference::pi / 180;
    ahead.first = -90 * ahead.step;
    ahead.beam_time_ns = 0;
    ahead.noise = 0.01;
    ahead.reach = 8;
    return ahead;
}

/* How far a robot that has driven straight on is off, m and rad together. */
double off_straight(const ale_estimate_t &e, double x)
{
    return std::hypot(e.map.x_um * 1e-6 - x, e.map.y_um * 1e-6) +
           std::abs(std::remainder(convert::radians(e.map.theta_bam), 2 * reference::pi));
}

struct Along {
    double off = 0; /* at most, m and rad together */
    bool lost = false;
};

/* A robot drives along that corridor and sees a scan of half a turn after each step; before every fifth it
 * waits. */
Along along_recesses(double step_m, unsigned seed, double wait_s)
{
    constexpr double period_s = 3.5;
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor ahead = looks_ahead();
    std::mt19937 rng(seed);
    const std::vector<room::Wall> walls = corridor_with_recesses();
    ale_estimate_t e = {};
    Along most;
    for (int k = 0; k * step_m < 40; k++) {
        const double x = k * step_m;
        const double t = k * period_s + k / 5 * wait_s;
        const ale_odometry_t sample = {std::llround(t * 1e6),
                                       {static_cast<int32_t>(std::llround(x * 1e6)), 0, 0}};
        ale_pipeline_odometry(p.get(), &sample);
        const reference::Pose place(x, 0, 0);
        const ale_scan_t scan = room::scan_at(
            walls, ahead, [&](double) { return place; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        most.lost = most.lost || e.state == ALE_STATE_LOST;
        most.off = std::max(most.off, off_straight(e, x));
    }
    return most;
}

TEST(StepRecover, InACorridorThatRepeatsItselfNoOtherPartOfItIsTaken)
{
    for (const double step_m : {1.0, 1.5, 2.0, 2.5, 3.0}) {
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            EXPECT_LT(along_recesses(step_m, seed, 0).off, 1) << step_m << " m a scan, seed " << seed;
        }
    }
}

/* A log with a scan after every step, however long that took. */
TEST(StepRecover, AStepThatTakesLongIsNoTimeThatNobodyWatched)
{
    for (const double step_m : {0.7, 1.0}) {
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            const Along drive = along_recesses(step_m, seed, 16);
            EXPECT_FALSE(drive.lost) << step_m << " m a scan, seed " << seed;
            EXPECT_LT(drive.off, 0.5) << step_m << " m a scan, seed " << seed;
        }
    }
}

/* A corridor of rooms no two of which are alike. */
std::vector<room::Wall> corridor_of_rooms()
{
    return {{-1, -1, 3, -1},    {3, -1, 3, -3},       {3, -3, 6.5, -3},     {6.5, -3, 6.5, -1},
            {6.5, -1, 17, -1},  {-1, -1, -1, 1.2},    {-1, 1.2, 5, 1.2},    {5, 1.2, 5, 2.6},
            {5, 2.6, 8.2, 2.6}, {8.2, 2.6, 8.2, 1.2}, {8.2, 1.2, 11, 1.2},  {11, 1.2, 11, 4},
            {11, 4, 12.4, 4},   {12.4, 4, 12.4, 1.2}, {12.4, 1.2, 17, 1.2}, {17, -1, 17, 1.2}};
}

constexpr double step_of_a_scan = 0.9;   // m
constexpr double period_of_a_scan = 2.5; // s

struct After {
    double off = 0; /* in the end, m and rad together */
    int wrong = 0;  /* scans that are good and more than 0.3 off */
};

/* It is seen by a scan after every step. Before one of them wheels tell of a step that the robot has not
 * gone. */
After after_a_wrong_step(const reference::Pose &wrong, int at_scan, unsigned seed)
{
    const std::vector<room::Wall> walls = corridor_of_rooms();
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor ahead = looks_ahead();
    std::mt19937 rng(seed);
    ale_estimate_t e = {};
    After after;
    for (int k = 0; k < 16; k++) {
        const double x = k * step_of_a_scan;
        const ale_pose_t before = convert::pose(reference::Pose{(at_scan - 1) * step_of_a_scan, 0, 0});
        const ale_pose_t since = convert::pose(reference::Pose{(k - at_scan) * step_of_a_scan, 0, 0});
        const ale_pose_t wheels =
            k < at_scan ? convert::pose(reference::Pose{x, 0, 0})
                        : ale_pose_compose(ale_pose_compose(before, convert::pose(wrong)), since);
        const double t = k * period_of_a_scan;
        const ale_odometry_t sample = {std::llround(t * 1e6), wheels};
        ale_pipeline_odometry(p.get(), &sample);
        const ale_scan_t scan = room::scan_at(
            walls, ahead, [&](double) { return reference::Pose(x, 0, 0); }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        after.off = off_straight(e, x);
        after.wrong += e.state == ALE_STATE_GOOD && after.off > 0.3;
    }
    return after;
}

/* New ground comes into view with every scan: what the map holds of it does not explain it, but the last scan
 * has seen the robot go. */
TEST(StepRecover, AWrongStepOfALogWithAScanNowAndThenIsSeenByTheLastScan)
{
    const reference::Pose steps[] = {{-0.3, 0.6, -1.4}, {0, 0, 1.2}, {-0.9, 0, 0}};
    for (const reference::Pose &wrong : steps) {
        for (const int at_scan : {3, 5, 6}) {
            for (const unsigned seed : {1U, 2U, 3U}) {
                EXPECT_LT(after_a_wrong_step(wrong, at_scan, seed).off, 0.15)
                    << wrong.transpose() << " before scan " << at_scan << ", seed " << seed;
            }
        }
    }
}

/* Where another pose explains the scan better but is not sure enough to be taken. */
TEST(StepRecover, AWrongStepThatIsNotTakenBackIsNotGood)
{
    struct Case {
        reference::Pose wrong;
        int at_scan;
    };
    const Case cases[] = {{{-0.9, 0, 0}, 2},    {{0.9, 0.8, 0.4}, 2},  {{0.4, 0.1, 0.1}, 2},
                          {{2.2, 0, 0}, 2},     {{0.2, -0.3, 0.6}, 2}, {{0.2, -0.3, 0.6}, 9},
                          {{0.4, 0.1, 0.1}, 4}, {{2.2, 0, 0}, 4},      {{1.5, 0.9, 1.5}, 4},
                          {{1.5, 0.9, 1.5}, 6}};
    for (const Case &c : cases) {
        for (const unsigned seed : {1U, 2U, 3U}) {
            EXPECT_EQ(after_a_wrong_step(c.wrong, c.at_scan, seed).wrong, 0)
                << c.wrong.transpose() << " before scan " << c.at_scan << ", seed " << seed;
        }
    }
}

/* Through the same corridor, but before one of the scans the robot is carried on in `away_s`, and wheels tell
 * of nothing. How many scans are good and more than 0.3 m off. */
int wrong_after_being_carried(double carried_m, double away_s, int at_scan, unsigned seed)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor ahead = looks_ahead();
    const std::vector<room::Wall> walls = corridor_of_rooms();
    std::mt19937 rng(seed);
    ale_estimate_t e = {};
    int wrong = 0;
    for (int k = 0; k < 13; k++) {
        const bool carried = k >= at_scan;
        const double told_m = (carried ? k - 1 : k) * step_of_a_scan;
        const double x = told_m + (carried ? carried_m : 0);
        const double t = k * period_of_a_scan + (carried ? away_s : 0);
        const ale_odometry_t sample = {std::llround(t * 1e6), convert::pose(reference::Pose{told_m, 0, 0})};
        ale_pipeline_odometry(p.get(), &sample);
        const ale_scan_t scan = room::scan_at(
            walls, ahead, [&](double) { return reference::Pose(x, 0, 0); }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        wrong += e.state == ALE_STATE_GOOD && off_straight(e, x) > 0.3;
    }
    return wrong;
}

/* What wheels tell from one scan to the next after that time is no way through it. */
TEST(StepRecover, CarriedOnWhereAScanComesNowAndThenTheRobotDoesNotGoOnFromWhereItStood)
{
    for (const double carried_m : {3.0, 5.0, 6.8, 7.0, 7.2}) {
        for (const double away_s : {15.0, 30.0}) {
            for (const unsigned seed : {1U, 2U, 3U}) {
                EXPECT_EQ(wrong_after_being_carried(carried_m, away_s, 5, seed), 0)
                    << carried_m << " m in " << away_s << " s, seed " << seed;
            }
        }
    }
}

// A scanner whose beams are all of one instant.
room::Sensor sees_at_once()
{
    room::Sensor sensor;
    sensor.beam_time_ns = 0;
    sensor.noise = 0.01;
    return sensor;
}

/* Two rooms of 5 m by 4 m that are furnished alike, with a door between them at y = 0. */
std::vector<room::Wall> two_alike_rooms()
{
    std::vector<room::Wall> walls;
    for (const double x : {0.0, 5.0}) {
        walls.insert(walls.end(), {{x, -2, x + 5, -2},
                                   {x, 2, x + 5, 2},
                                   {x, -2, x, -0.5},
                                   {x, 0.5, x, 2},
                                   {x + 5, -2, x + 5, -0.5},
                                   {x + 5, 0.5, x + 5, 2},
                                   {x + 1, 1.4, x + 2.2, 1.4},
                                   {x + 2.2, 1.4, x + 2.2, 2},
                                   {x + 3.6, -2, x + 3.6, -1.1},
                                   {x + 3.6, -1.1, x + 5, -1.1}});
    }
    return walls;
}

/* A robot drives in the first room to `from`; then the scanner is away for eight seconds while wheels go on,
 * to `to`, and it drives on there. Returns by how much it is ever off, m, where it says that it knows. */
double most_off_after_an_outage(double from, double to, unsigned seed)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor around = sees_at_once();
    std::mt19937 rng(seed);
    const std::vector<room::Wall> walls = two_alike_rooms();
    constexpr double away_at = 8;
    constexpr double away = 8;
    const auto way = [&](double t) {
        return t < away_at          ? 1 + (from - 1) * t / away_at
               : t < away_at + away ? from + (to - from) * (t - away_at) / away
                                    : to + 0.1 * (t - away_at - away);
    };
    ale_estimate_t e = {};
    double most = 0;
    for (int k = 0; k < 900; k++) {
        const double t = 0.02 * k;
        const ale_odometry_t told = {std::llround(t * 1e6),
                                     {static_cast<int32_t>(std::llround(1.01e6 * (way(t) - 1))), 0, 0}};
        ale_pipeline_odometry(p.get(), &told);
        if (k % 5 != 0 || (t > away_at && t < away_at + away)) {
            continue;
        }
        const reference::Pose place(way(t), 0, 0);
        const ale_scan_t scan = room::scan_at(
            walls, around, [&](double) { return place; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        const double off = std::hypot(e.map.x_um * 1e-6 - (way(t) - 1), e.map.y_um * 1e-6);
        most = e.state == ALE_STATE_GOOD ? std::max(most, off) : most;
    }
    return most;
}

TEST(StepRecover, ARoomLikeTheKnownOneIsNotTakenForItWhenWheelsHaveLedToTheNext)
{
    for (const unsigned seed : {1U, 2U, 3U}) {
        EXPECT_LT(most_off_after_an_outage(2, 7, seed), 0.15) << "at the same place of it, seed " << seed;
        EXPECT_LT(most_off_after_an_outage(3.6, 6.4, seed), 0.15) << "at another, seed " << seed;
    }
}

/* A robot turns on the spot while the scanner is away for three seconds, and nothing of what it sees then is
 * in its map; wheels tell of a part of the turn with the first scan that comes again, and the rest after it.
 * Returns by how much it is turned wrongly two scans later, rad. */
double turned_after_wheels_told_late(unsigned seed)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor around = sees_at_once();
    std::mt19937 rng(seed);
    const auto way = [](double t) {
        return reference::Pose(0, 0, 0.1 * std::min(t, 2.0) + 0.5 * std::clamp(t - 2, 0.0, 3.0));
    };
    const auto place = [&](double t) { return reference::Pose(way(t) + reference::Pose(1, 0, 0)); };
    ale_estimate_t e = {};
    for (int k = 0; k <= 52; k++) {
        const double t = 0.1 * k;
        if (k <= 20 || k >= 50) {
            const ale_odometry_t told = {std::llround(t * 1e6), convert::pose(way(k == 50 ? 3 : t))};
            ale_pipeline_odometry(p.get(), &told);
            const ale_scan_t scan =
                room::scan_at(k <= 20 ? room::l_shape() : two_alike_rooms(), around, place, t, rng);
            ale_pipeline_scan(p.get(), &scan, &e);
        }
    }
    return std::abs(reference::wrap(convert::pose(e.map)[2] - way(5)[2]));
}

TEST(StepRecover, WhileItWaitsForWheelsThatAreToldLateTheWayIsThatOfTheWheels)
{
    for (const unsigned seed : {1U, 2U, 3U}) {
        EXPECT_LT(turned_after_wheels_told_late(seed), 0.05) << "seed " << seed;
    }
}

/* A robot turns on the spot while the scanner is away for three seconds; wheels tell how it began to turn,
 * the same with the first scan that comes again, and the rest after it. Returns how many scans it is lost. */
int lost_after_a_turn_told_of_late(unsigned seed)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    const room::Sensor around = sees_at_once();
    std::mt19937 rng(seed);
    std::vector<room::Wall> walls = two_alike_rooms();
    walls.resize(walls.size() / 2); // the first of them
    const auto way = [](double t) {
        return reference::Pose(0.2 * std::min(t, 7.0), 0,
                               0.9 * std::min(t, 7.0) + 0.5 * std::max(t - 7, 0.0));
    };
    const auto place = [&](double t) { return reference::Pose(way(t) + reference::Pose(1, 0, 0)); };
    const auto tell = [&](double t, double of_t) {
        const ale_odometry_t told = {std::llround(t * 1e6), convert::pose(way(of_t))};
        ale_pipeline_odometry(p.get(), &told);
    };
    ale_estimate_t e = {};
    int lost = 0;
    for (int k = 0; k < 150; k++) {
        const double t = 0.1 * k;
        const bool away = k > 80 && k < 110;
        if (!away) {
            tell(t, k == 110 ? 8.75 : t);
            const ale_scan_t scan = room::scan_at(walls, around, place, t, rng);
            ale_pipeline_scan(p.get(), &scan, &e);
            lost += e.state == ALE_STATE_LOST;
        }
        if (!away || k <= 87) {
            tell(t + 0.05, t + 0.05);
        }
    }
    return lost;
}

TEST(StepRecover, WheelsThatAreToldOfLateAfterATimeWithoutScansAreWaitedFor)
{
    for (const unsigned seed : {1U, 2U, 3U}) {
        EXPECT_EQ(lost_after_a_turn_told_of_late(seed), 0) << "seed " << seed;
    }
}

} // namespace
