// lib/match/pose_evidence.c: what speaks for a pose and what against it.
#include "lib/map/walls.h"
#include "lib/observe/look.h"

extern "C" {
#include "match/pose_evidence.h"
}

namespace
{

constexpr int64_t most_um = 1500000; /* that one surface counts for */

/* A robot at the origin, a scan all around it with one range, and what a fit says. */
struct Evidence : testing::Test {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_scan_t> scan = std::make_unique<ale_scan_t>();
    std::unique_ptr<ale_fit_t> fit = std::make_unique<ale_fit_t>();
    std::vector<ale_observation_t> observations;

    void SetUp() override
    {
        ale_local_map_clear(map.get());
        scan->beams = 720;
        scan->step_bam = static_cast<int32_t>(convert::bam(2 * reference::pi / 720));
        scan->range_min_um = 20000;
        scan->range_max_um = 30000000;
        look(5);
    }
    void look(double range)
    {
        for (uint16_t k = 0; k < scan->beams; k++) {
            ale_scan_set_range(scan.get(), k, convert::um(range));
        }
    }
    void add(double x, double y, double normal, double half)
    {
        const ale_wall_t wall = make_wall(x, y, normal, half);
        ale_local_map_add(map.get(), &wall);
    }
    void observe(double length, uint16_t wall, int32_t landmark)
    {
        ale_observation_t o = {};
        o.end_um = convert::um(length / 2);
        o.start_um = -o.end_um;
        fit->association[observations.size()] = {wall, landmark, {}};
        observations.push_back(o);
    }
    int64_t evidence()
    {
        ale_local_map_approach(map.get(), {0, 0}, 30000000);
        const ale_scene_t scene = {map.get(), observations.data(), static_cast<uint32_t>(observations.size()),
                                   nullptr};
        const ale_posed_scan_t from = {scan.get(), nullptr, {0, 0, 0}};
        return ale_pose_evidence_um(&scene, fit.get(), &from);
    }
};

} // namespace

TEST_F(Evidence, NothingSaysNothing)
{
    EXPECT_EQ(evidence(), 0);
    observe(1, ALE_NO_WALL, ALE_NO_LANDMARK);
    EXPECT_EQ(evidence(), 0) << "what the map does not hold";
    look(1);
    add(3, 0, reference::pi, 1);
    EXPECT_EQ(evidence(), 0) << "what something hides";
}

TEST_F(Evidence, WhatIsFoundInTheMapSpeaksForThePose)
{
    observe(1, 0, ALE_NO_LANDMARK);
    EXPECT_EQ(evidence(), 1000000);
    observe(0.2, ALE_NO_WALL, 7);
    EXPECT_EQ(evidence(), 1200000);
    observe(12, 1, ALE_NO_LANDMARK);
    EXPECT_EQ(evidence(), 1200000 + most_um) << "a surface counts for no more than that";
}

TEST_F(Evidence, WallsThatAreLookedThroughSpeakAgainstIt)
{
    add(2, 0, reference::pi, 0.4);
    EXPECT_NEAR(static_cast<double>(evidence()), -800000, 2);
    add(0, 3, -reference::pi / 2, 3);
    EXPECT_NEAR(static_cast<double>(evidence()), -800000 - most_um, 2);
    look(2.1);
    EXPECT_EQ(evidence(), 0) << "the first stands there, the second is hidden";
}

TEST_F(Evidence, AWallThatIsLookedThroughInPartCountsForThatPart)
{
    add(2, 0, reference::pi, 0.6);
    for (uint16_t k = 715; k < 720; k++) {
        ale_scan_set_range(scan.get(), k, 1000000);
    }
    for (uint16_t k = 0; k < 5; k++) {
        ale_scan_set_range(scan.get(), k, 1000000);
    }
    EXPECT_NEAR(static_cast<double>(evidence()), -1200000 * 2.0 / 3, 2);
}

TEST_F(Evidence, WallsOfAnotherMapSayNothing)
{
    add(2, 0, reference::pi, 0.4);
    ale_local_map_select(map.get(), 1);
    EXPECT_EQ(evidence(), 0);
}

TEST_F(Evidence, IsBoundedWhateverTheMapHolds)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < ALE_MAP_MAX_LINES; k++) {
        const double a = reference::pi * unit(rng);
        add(2 * std::cos(a), 2 * std::sin(a), a + reference::pi, 3);
    }
    const int64_t all = evidence();
    EXPECT_GE(all, -most_um * ALE_EVIDENCE_WALLS);
    EXPECT_LT(all, -most_um * ALE_EVIDENCE_WALLS / 3) << "as many as may be asked";
}

/* However many there are, they take nothing of what is asked: backs of walls, and what lies beyond all that
 * is seen. */
TEST_F(Evidence, WallsThatCannotBeInViewAreNotAsked)
{
    for (int k = 0; k < 2 * ALE_EVIDENCE_WALLS; k++) {
        add(2, 0, 0, 1);
        add(20, 0, reference::pi, 1);
    }
    EXPECT_EQ(evidence(), 0);
    add(2, 0, reference::pi, 0.4);
    EXPECT_NEAR(static_cast<double>(evidence()), -800000, 2);
}

/* The right pose explains more of a scan than any that is clearly elsewhere. */
TEST(PoseEvidence, TheTruePoseHasMoreThanAnyOther)
{
    std::mt19937 rng(8);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto map = std::make_unique<ale_local_map_t>();
    ale_local_map_clear(map.get());
    for (const room::Wall &w : room::l_shape()) {
        const ale_wall_t wall = make_wall((w.x1 + w.x2) / 2, (w.y1 + w.y2) / 2,
                                          std::atan2(w.y2 - w.y1, w.x2 - w.x1) + reference::pi / 2,
                                          std::hypot(w.x2 - w.x1, w.y2 - w.y1) / 2);
        ale_local_map_add(map.get(), &wall);
    }
    const auto fit = std::make_unique<ale_fit_t>();
    const ale_gate_t gate = {300000, 200000, 6, 100000};
    for (int trial = 0; trial < 40; trial++) {
        const reference::Pose truth(0.6 + 0.8 * unit(rng), -0.5 + 0.8 * unit(rng), 3 * unit(rng));
        const room::Look look(room::l_shape(), truth, truth);
        const ale_scene_t scene = {map.get(), look.seen.observation, look.seen.observation_count, nullptr};
        ale_local_map_approach(map.get(), {0, 0}, 20000000);
        const auto evidence_at = [&](const reference::Pose &pose) {
            ale_motion_t start;
            ale_motion_init(&start, 0, convert::pose(pose), 300, 500);
            ale_motion_widen(&start, 150000, 60000);
            ale_register_scan(&start, &scene, &gate, fit.get());
            const ale_posed_scan_t from = {look.scan.get(), nullptr, fit->motion.pose};
            return ale_pose_evidence_um(&scene, fit.get(), &from);
        };
        const int64_t there = evidence_at(truth);
        EXPECT_GT(there, 3000000) << trial;
        for (int k = 0; k < 20; k++) {
            const reference::Pose off(unit(rng), unit(rng), 3 * unit(rng));
            const int64_t other = evidence_at(truth + off);
            const reference::Pose error = room::since_start(truth, convert::pose(fit->motion.pose));
            const bool same = error.head<2>().norm() < 0.2 && std::abs(reference::wrap(error[2])) < 0.1;
            EXPECT_TRUE(same || other < there) << trial << " " << k;
        }
    }
}

/* Twin in double: the axis that is most sigmas off, squared. */
TEST(Against, IsTheSquareOfTheDeviationInSigmasAndBounded)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int trial = 0; trial < 500; trial++) {
        const double sigmas[] = {0.01 + 0.1 * std::abs(unit(rng)), 0.01 + 0.1 * std::abs(unit(rng)), 0.02};
        const reference::Pose predicted(5 * unit(rng), 5 * unit(rng), 3 * unit(rng));
        const reference::Pose off(0.3 * unit(rng), 0.3 * unit(rng), 0.06 * unit(rng));
        ale_motion_t motion = {};
        motion.pose = convert::pose(predicted);
        double most = 0;
        for (int i = 0; i < ALE_AXES; i++) {
            motion.cov.m[i][i] = std::llround(sigmas[i] * sigmas[i] * 1e12);
            most = std::max(most, std::pow(off[i] / sigmas[i], 2));
        }
        const ale_pose_t pose = convert::pose(reference::compose(predicted, off));
        const double told = static_cast<double>(ale_pose_against_um(&motion, pose));
        EXPECT_NEAR(told, 100000 * std::min(most, 25.0), 2000 + 0.02 * told) << trial;
        EXPECT_LE(told, ALE_EVIDENCE_AGAINST_UM);
        EXPECT_EQ(ale_pose_against_um(&motion, motion.pose), 0);
    }
}
