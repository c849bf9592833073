// lib/track/step_search.c: carried away, or started in a loaded map.
#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/keyframe.h"
#include "track/scan_observation.h"
}

namespace
{
/* A robot without wheels, carried between two scans to a place where it then drives to and fro. */
struct Carried {
    int wrong_while_good = 0;
    bool good_at_once = false;
    ale_estimate_t last = {};
    double off_m = 0;
    double off_rad = 0;
    double longest_m = 0; /* step of the smooth pose */
};

Carried carry(const reference::Pose &there, double way_m, unsigned seed)
{
    ale_pipeline_config_t config = ale_pipeline_default_config();
    config.use_odometry = false;
    const room::Pipeline p = room::make(config);
    std::mt19937 rng(seed);
    room::Sensor sensor;
    sensor.noise = 0.003;
    Carried c;
    double t = 1;
    for (int k = 0; k < 180; k++, t += 0.1) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &c.last);
    }
    const double carried_s = t;
    const auto path = [&](double time) {
        const double s = std::max(time - carried_s, 0.0);
        return reference::compose(there, {way_m * (1 - std::cos(0.3 * s)) / 2, 0, 0.6 * std::sin(0.4 * s)});
    };
    for (int k = 0; k < 240; k++, t += 0.1) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, path, t, rng);
        const reference::Pose truth = room::since_start(room::path(1), path(t));
        const ale_pose_t before = c.last.smooth;
        ale_pipeline_scan(p.get(), &scan, &c.last);
        const reference::Pose error = room::since_start(truth, convert::pose(c.last.map));
        const reference::Pose step = room::since_start(convert::pose(before), convert::pose(c.last.smooth));
        const bool good = c.last.state == ALE_STATE_GOOD;
        c.off_m = error.head<2>().norm();
        c.off_rad = std::abs(reference::wrap(error[2]));
        c.wrong_while_good += good && (c.off_m > 0.1 || c.off_rad > 0.1);
        c.good_at_once = c.good_at_once || (k == 0 && good);
        c.longest_m = std::max(c.longest_m, step.head<2>().norm());
    }
    return c;
}
} // namespace

/* Put aside within reach of what it can do in the time, and turned farther than it can turn: what is said
 * while it looks for itself is never good, and in the end it is right. */
TEST(PipelineSearch, CarriedAwayItIsNotGoodBeforeItHasFoundItselfInTheMap)
{
    const reference::Pose stopped = room::path(19);
    const struct {
        const char *name;
        reference::Pose there;
        double way_m;
        bool in_reach; /* of one scan period, at the speed that the configuration names */
    } places[] = {{"a little aside", reference::compose(stopped, {0.3, 0.2, 0.4}), 0.3, true},
                  {"turned", reference::compose(stopped, {0.9, -0.7, 2.2}), 0.3, false},
                  {"turned back", reference::compose(stopped, {0.1, 0, 3.1}), 0.3, false}};
    for (const auto &place : places) {
        for (unsigned seed = 5; seed < 8; seed++) {
            const Carried c = carry(place.there, place.way_m, seed);
            EXPECT_EQ(c.wrong_while_good, 0) << place.name << " " << seed;
            EXPECT_TRUE(place.in_reach || !c.good_at_once) << place.name << " " << seed;
            EXPECT_EQ(c.last.state, ALE_STATE_GOOD) << place.name << " " << seed;
            EXPECT_LT(c.off_m, 0.03) << place.name << " " << seed;
            EXPECT_LT(c.off_rad, 0.02) << place.name << " " << seed;
            EXPECT_LT(c.longest_m, 0.6) << place.name << " " << seed;
            EXPECT_EQ(c.last.map_id, 0U) << place.name << " " << seed;
        }
    }
}

/* Carried to another place between two scans, whichever it is: it never says good while it is wrong. */
TEST(PipelineSearch, CarriedAnywhereItIsNeverWrongWhileItSaysGood)
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

/* Between two scans the robot is carried away. Until it is said where it is, neither its map nor whoever maps
 * beside it may take what it sees. */
TEST(PipelineSearch, CarriedAwayItShowsNothingToTheMapperBeforeItIsFound)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(5);
    room::Sensor sensor;
    sensor.noise = 0.003;
    const auto keyframe = std::make_unique<ale_keyframe_t>();
    const auto scan_observation = std::make_unique<ale_scan_observation_t>();
    const auto map = std::make_unique<ale_map_t>();
    ale_estimate_t e = {};
    double t = 1;
    for (int k = 0; k < 180; k++, t += 0.1) {
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(room::path(t))};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        ale_pipeline_keyframe(p.get(), keyframe.get());
    }
    const reference::Pose stopped = room::path(t - 0.1);
    const reference::Pose there = reference::compose(stopped, {0.9, -0.7, 2.2});
    int shown_wrong = 0;
    bool broken = false;
    for (int k = 0; k < 120; k++, t += 0.1) {
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(stopped)};
        ale_pipeline_odometry(p.get(), &wheels);
        const ale_scan_t scan = room::scan_at(
            room::l_shape(), sensor, [&](double) { return there; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose error =
            room::since_start(convert::pose(e.map), room::since_start(room::path(1), there));
        const bool wrong = error.head<2>().norm() > 0.1;
        const bool taken = ale_pipeline_keyframe(p.get(), keyframe.get());
        broken = broken || (taken && keyframe->broken);
        ale_seen_t seen;
        shown_wrong += wrong && (taken || ale_pipeline_scan_observation(p.get(), scan_observation.get()) ||
                                 ale_pipeline_seen(p.get(), &seen));
    }
    EXPECT_EQ(e.state, ALE_STATE_GOOD);
    EXPECT_TRUE(broken);
    EXPECT_EQ(shown_wrong, 0);
}

TEST(PipelineSearch, StartsInALoadedMapWhereverItStands)
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
    ale_pipeline_load_map(second.get(), map.get(), 1, {0, 0, 0}, false);
    for (int k = 0; k < 100; k++) {
        const ale_scan_t scan = room::scan_at(room::l_shape(), room::Sensor(), room::path, 9 + 0.1 * k, rng);
        ale_pipeline_scan(second.get(), &scan, &e);
        EXPECT_TRUE(k > 0 || e.state != ALE_STATE_GOOD);
    }
    const reference::Pose truth = room::since_start(room::path(1), room::path(18.9));
    EXPECT_LT((convert::pose(e.map) - truth).head<2>().norm(), 0.03);
}

/* Covered for 1.4 and for 2.5 s while it drives on, without wheels: the way goes on elsewhere than before,
 * and what is seen then is not where the prediction puts it. That is no new place that the map could go on
 * from.
 */
TEST(PipelineSearch, CoveredOnItsWayItIsNeverWrongWhileItSaysGood)
{
    for (const int covered : {14, 25}) {
        std::mt19937 rng(9);
        ale_pipeline_config_t config = ale_pipeline_default_config();
        config.use_odometry = false;
        const room::Pipeline p = room::make(config);
        room::Sensor sensor;
        sensor.noise = 0.003;
        ale_estimate_t e;
        for (int k = 0; k < 80 + covered + 30; k++) {
            const double t = 1 + 0.1 * k;
            const bool dark = k >= 80 && k < 80 + covered;
            const ale_scan_t scan =
                room::scan_at(dark ? std::vector<room::Wall>() : room::l_shape(), sensor, room::path, t, rng);
            ale_pipeline_scan(p.get(), &scan, &e);
            const reference::Pose error =
                convert::pose(e.map) - room::since_start(room::path(1), room::path(t));
            const bool right = error.head<2>().norm() < 0.1 && std::abs(reference::wrap(error[2])) < 0.1;
            EXPECT_TRUE(right || e.state != ALE_STATE_GOOD) << covered << " dark, scan " << k;
            EXPECT_TRUE(!dark || e.state != ALE_STATE_GOOD) << covered << " dark, scan " << k;
        }
        EXPECT_TRUE(covered > 14 || e.state == ALE_STATE_GOOD);
    }
}

/* Covered while a wheel spins in the air; how many scans were wrong and said to be good. */
int wrong_while_good(double spin, int covered, unsigned seed)
{
    const double drives_s = 2.5;
    const auto path = [&](double t) { return room::bend(t, drives_s); };
    std::mt19937 rng(seed);
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    room::Sensor sensor;
    sensor.noise = 0.004;
    ale_estimate_t e = {};
    int wrong = 0;
    for (int k = 0; k < 90; k++) {
        const double t = 0.1 * k;
        const double since_s = t - drives_s;
        const double covered_s = 0.1 * covered;
        reference::Pose counted = path(t);
        counted[2] += spin * std::clamp(since_s, 0.0, covered_s);
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(counted)};
        ale_pipeline_odometry(p.get(), &wheels);
        const bool dark = since_s > 0 && since_s < covered_s;
        const ale_scan_t scan =
            room::scan_at(dark ? std::vector<room::Wall>() : room::l_shape(), sensor, path, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
        const reference::Pose error =
            room::since_start(convert::pose(e.map), room::since_start(path(0), path(t)));
        wrong += e.state == ALE_STATE_GOOD &&
                 (error.head<2>().norm() > 0.3 || std::abs(reference::wrap(error[2])) > 0.1);
    }
    return wrong;
}

/* What it sees then is little of what the map holds there, and of what it saw before: no new place. */
TEST(PipelineSearch, AfterAWheelSpanUnseenItIsNeverWrongWhileItSaysGood)
{
    const struct {
        double spin;
        int covered;
    } drives[] = {{-6.5, 14}, {-5, 5}, {-3, 9}, {3, 3}, {3, 9}, {6.5, 5}, {6.5, 9}};
    for (const auto &drive : drives) {
        for (unsigned seed = 1; seed <= 3; seed++) {
            EXPECT_EQ(wrong_while_good(drive.spin, drive.covered, seed), 0)
                << drive.spin << " rad/s, " << drive.covered << " scans, seed " << seed;
        }
    }
}
