// lib/track/tracking_monitor: good, weak and lost, from made fits and testimonies.
#include <gtest/gtest.h>

#include <memory>

extern "C" {
#include "track/tracking_monitor.h"
}

namespace
{

constexpr int64_t metre_um = 1000000;

int64_t square(int64_t v)
{
    return v * v;
}

/* A scan that shows so much, of which so much was found; every direction determined to a millimetre, or none.
 */
std::unique_ptr<ale_fit_t> fit_of(int64_t shown_um, int64_t matched_um, uint16_t walls = 6,
                                  bool determined = true)
{
    auto fit = std::make_unique<ale_fit_t>();
    fit->shown_um = shown_um;
    fit->matched_um = matched_um;
    fit->matched = walls;
    for (int i = 0; i < 3; i++) {
        fit->motion.cov.m[i][i] = square(5000);
        /* information 1/(1 mm)^2, in 1/um^2 */
        fit->information.matrix.m[i][i] = determined ? (int64_t{1} << ALE_MATRIX_BITS) / square(1000) : 0;
    }
    return fit;
}

ale_testimony_t testimony_of(int64_t confirmed_um, int64_t denied_um, bool close = true)
{
    return {10 * metre_um, confirmed_um, denied_um, close};
}

struct Monitor {
    ale_tracking_monitor_t m;
    Monitor()
    {
        ale_tracking_init(&m);
    }
    ale_state_t judge(const ale_fit_t &fit, uint16_t supported = 0, uint16_t violated = 0)
    {
        const ale_visibility_counts_t counts = {supported, violated};
        return ale_tracking_judge(&m, &fit, &counts, false);
    }
    bool contradicted(const ale_testimony_t *testimony, bool counted = true)
    {
        ale_tracking_notice(&m, testimony, counted, true);
        return m.contradicted;
    }
};

TEST(TrackingMonitor, AScanThatFitsAndDeterminesAllIsGood)
{
    Monitor monitor;
    EXPECT_EQ(monitor.judge(*fit_of(10 * metre_um, 9 * metre_um)), ALE_STATE_GOOD);
}

TEST(TrackingMonitor, AScanThatLeavesADirectionOpenIsWeakAndLostBeyondAMetre)
{
    Monitor monitor;
    auto fit = fit_of(10 * metre_um, 9 * metre_um, 6, false);
    EXPECT_EQ(monitor.judge(*fit), ALE_STATE_WEAK);
    fit->motion.cov.m[1][1] = square(metre_um + 1);
    EXPECT_EQ(monitor.judge(*fit), ALE_STATE_LOST);
}

TEST(TrackingMonitor, APoseOfPoorVarianceIsWeakWhateverTheScanDetermines)
{
    Monitor monitor;
    auto fit = fit_of(10 * metre_um, 9 * metre_um);
    fit->motion.cov.m[0][0] = square(100000);
    EXPECT_EQ(monitor.judge(*fit), ALE_STATE_WEAK);
}

TEST(TrackingMonitor, FreeSpaceViolatedScanAfterScanIsLostAndOneFitTakesBackOne)
{
    Monitor monitor;
    const auto fit = fit_of(10 * metre_um, 3 * metre_um, 2);
    int scans = 1;
    while (monitor.judge(*fit, 1, 12) != ALE_STATE_LOST) {
        ASSERT_LT(scans++, 50);
    }
    Monitor interrupted;
    for (int i = 1; i < scans; i++) {
        interrupted.judge(*fit, 1, 12);
    }
    interrupted.judge(*fit_of(10 * metre_um, 9 * metre_um));
    EXPECT_NE(interrupted.judge(*fit, 1, 12), ALE_STATE_LOST);
    EXPECT_EQ(interrupted.judge(*fit, 1, 12), ALE_STATE_LOST);
}

TEST(TrackingMonitor, WallsThatAreThereOutweighThoseThatAreNot)
{
    Monitor monitor;
    const auto fit = fit_of(10 * metre_um, 9 * metre_um, 6);
    for (int i = 0; i < 50; i++) {
        ASSERT_EQ(monitor.judge(*fit, 2, 16), ALE_STATE_GOOD); /* 16 are not more than twice eight */
    }
}

TEST(TrackingMonitor, ALastScanThatDeniesOrDoesNotConfirmContradicts)
{
    Monitor monitor;
    const ale_testimony_t agrees = testimony_of(8 * metre_um, 1 * metre_um);
    const ale_testimony_t denies = testimony_of(6 * metre_um, 4 * metre_um);
    const ale_testimony_t silent = testimony_of(1 * metre_um, 0);
    EXPECT_FALSE(monitor.contradicted(&agrees));
    EXPECT_TRUE(monitor.contradicted(&denies));
    EXPECT_TRUE(monitor.contradicted(&silent));
    EXPECT_FALSE(monitor.contradicted(nullptr));
}

TEST(TrackingMonitor, TwoScansThatShowLittleCannotContradict)
{
    Monitor monitor;
    ale_testimony_t denies = testimony_of(0, 1500000);
    denies.shown_um = 1500000;
    EXPECT_FALSE(monitor.contradicted(&denies));
}

TEST(TrackingMonitor, ContradictionsAddUpToLostAndSayWhetherTheyWereCloseAtFirst)
{
    Monitor monitor;
    const auto fit = fit_of(10 * metre_um, 1 * metre_um);
    const ale_testimony_t denies = testimony_of(2 * metre_um, 6 * metre_um);
    ale_testimony_t far = denies;
    far.close = false;
    int scans = 0;
    do {
        ASSERT_LT(scans, 50);
        ASSERT_TRUE(monitor.contradicted(scans++ == 0 ? &denies : &far));
        ASSERT_TRUE(monitor.m.contradicted_nearby);
        ASSERT_FALSE(ale_tracking_may_map(&monitor.m, fit.get()));
    } while (monitor.judge(*fit) != ALE_STATE_LOST);
    EXPECT_GT(scans, 2);
}

TEST(TrackingMonitor, AfterAMisfitScansWithoutWheelsAreNotFollowed)
{
    Monitor monitor;
    const ale_testimony_t agrees = testimony_of(8 * metre_um, 0);
    const ale_testimony_t denies = testimony_of(0, 8 * metre_um);
    ASSERT_TRUE(monitor.contradicted(&denies));
    monitor.judge(*fit_of(10 * metre_um, 0));
    EXPECT_FALSE(monitor.contradicted(&agrees, true));
    EXPECT_TRUE(monitor.contradicted(&agrees, false));
}

TEST(TrackingMonitor, WhatIsFoundAgainIsWeakAndOnProbation)
{
    Monitor fresh;
    Monitor found;
    found.m.state = ALE_STATE_LOST;
    ale_tracking_found(&found.m);
    EXPECT_EQ(found.m.state, ALE_STATE_WEAK);
    const auto fit = fit_of(10 * metre_um, 3 * metre_um, 0);
    int fresh_scans = 0;
    int found_scans = 0;
    while (fresh.judge(*fit, 0, 12) != ALE_STATE_LOST) {
        fresh_scans++;
    }
    while (found.judge(*fit, 0, 12) != ALE_STATE_LOST) {
        found_scans++;
    }
    EXPECT_LT(found_scans, fresh_scans);
}

TEST(TrackingMonitor, ADroppedScanNeverFindsALostRobot)
{
    Monitor monitor;
    const auto fit = fit_of(0, 0);
    EXPECT_EQ(ale_tracking_skip(&monitor.m, &fit->motion), ALE_STATE_WEAK);
    auto far = fit_of(0, 0);
    far->motion.cov.m[0][0] = square(2 * metre_um);
    EXPECT_EQ(ale_tracking_skip(&monitor.m, &far->motion), ALE_STATE_LOST);
    EXPECT_EQ(ale_tracking_skip(&monitor.m, &fit->motion), ALE_STATE_LOST);
}

TEST(TrackingMonitor, AFoundPoseNeedsEnoughWallsAndMostOfWhatIsShown)
{
    EXPECT_TRUE(ale_tracking_accepts(fit_of(10 * metre_um, 9 * metre_um).get()));
    EXPECT_FALSE(ale_tracking_accepts(fit_of(10 * metre_um, 5 * metre_um).get()));
    EXPECT_FALSE(ale_tracking_accepts(fit_of(10 * metre_um, 9 * metre_um, 2).get()));
    EXPECT_FALSE(ale_tracking_accepts(fit_of(1 * metre_um, 1 * metre_um).get()));
    EXPECT_TRUE(ale_tracking_confirms(fit_of(10 * metre_um, 9 * metre_um, 2).get()));
    EXPECT_FALSE(ale_tracking_confirms(fit_of(10 * metre_um, 9 * metre_um, 2, false).get()));
}

TEST(TrackingMonitor, TheMapIsAddedToOrGoesOnNeverBoth)
{
    Monitor monitor;
    monitor.contradicted(nullptr);
    auto fit = fit_of(10 * metre_um, 9 * metre_um);
    EXPECT_TRUE(ale_tracking_may_map(&monitor.m, fit.get()));
    EXPECT_FALSE(ale_tracking_may_reanchor(&monitor.m, fit.get()));
    fit->motion.cov.m[0][0] = square(200000);
    EXPECT_FALSE(ale_tracking_may_map(&monitor.m, fit.get()));
    EXPECT_TRUE(ale_tracking_may_reanchor(&monitor.m, fit.get()));
    fit->shown_um = metre_um;
    EXPECT_FALSE(ale_tracking_may_reanchor(&monitor.m, fit.get()));
}

TEST(TrackingMonitor, WithoutWheelsAHeadingBeyondReachIsLostNotReanchored)
{
    Monitor monitor;
    monitor.contradicted(nullptr, false);
    auto fit = fit_of(10 * metre_um, 0);
    fit->motion.cov.m[2][2] = square(300000);
    EXPECT_FALSE(ale_tracking_may_reanchor(&monitor.m, fit.get()));
    EXPECT_EQ(monitor.judge(*fit), ALE_STATE_LOST);
}

TEST(TrackingMonitor, GoesFromGoodToWeakToLostAndBackByWhatScansShow)
{
    ale_tracking_monitor_t t;
    ale_tracking_init(&t);
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    const ale_visibility_counts_t fine = {3, 0};
    for (int i = 0; i < 3; i++) {
        fit.information.matrix.m[i][i] = int64_t{1} << 50;
    }
    fit.matched = 5;
    fit.shown_um = 4000000;
    fit.matched_um = 3800000;
    EXPECT_FALSE(ale_tracking_doubts(&fit));
    ale_tracking_notice(&t, nullptr, true, true);
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &fine, false), ALE_STATE_GOOD);
    EXPECT_TRUE(ale_tracking_may_map(&t, &fit));
    fit.information.matrix.m[0][0] = 0;
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &fine, false), ALE_STATE_WEAK);
    const ale_visibility_counts_t violated = {0, 12};
    fit.matched = 0;
    for (int k = 0; k < 7; k++) {
        EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated, false), ALE_STATE_WEAK);
        EXPECT_FALSE(ale_tracking_may_map(&t, &fit));
    }
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated, false), ALE_STATE_LOST);
    EXPECT_EQ(ale_tracking_skip(&t, &fit.motion), ALE_STATE_LOST);
    ale_tracking_found(&t);
    EXPECT_EQ(t.state, ALE_STATE_WEAK);
}

TEST(TrackingMonitor, APoseThatTheMapDoesNotHoldIsWhereTheMapGoesOnUnlessTheLastScanDeniesIt)
{
    ale_tracking_monitor_t t;
    ale_tracking_init(&t);
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    fit.motion.cov.m[0][0] = int64_t{80000} * 80000;
    fit.shown_um = 5000000;
    EXPECT_TRUE(ale_tracking_doubts(&fit));
    const ale_testimony_t agreed = {8000000, 5000000, 800000, true};
    ale_tracking_notice(&t, &agreed, true, true);
    EXPECT_FALSE(ale_tracking_may_map(&t, &fit));
    EXPECT_TRUE(ale_tracking_may_reanchor(&t, &fit));
    const ale_testimony_t denied = {8000000, 800000, 3000000, true};
    ale_tracking_notice(&t, &denied, true, true);
    EXPECT_TRUE(t.contradicted);
    EXPECT_FALSE(ale_tracking_may_reanchor(&t, &fit));
}

TEST(TrackingMonitor, TwoScansOfARobotThatStoodMustNotDenyAMetreAndATwentiethOfWhatBothLookAt)
{
    const ale_testimony_t people = {40000000, 30000000, 950000, true};
    const ale_testimony_t small_part = {60000000, 50000000, 1500000, true};
    const ale_testimony_t elsewhere = {18500000, 13300000, 1150000, true};
    EXPECT_FALSE(ale_tracking_denies(&people));
    EXPECT_FALSE(ale_tracking_denies(&small_part));
    EXPECT_TRUE(ale_tracking_denies(&elsewhere));
}

TEST(TrackingMonitor, TwoScansAtTheEndsOfAStepMustNotDenyAFifthOfWhatBothLookAt)
{
    const ale_testimony_t clutter = {40000000, 20000000, 4900000, false};
    const ale_testimony_t a_little = {4000000, 1000000, 950000, false};
    const ale_testimony_t elsewhere = {40000000, 20000000, 5100000, false};
    EXPECT_FALSE(ale_tracking_denies_step(&clutter));
    EXPECT_FALSE(ale_tracking_denies_step(&a_little)) << "less than a metre is denied";
    EXPECT_TRUE(ale_tracking_denies_step(&elsewhere));
}

TEST(TrackingMonitor, AfterATimeUnwatchedTheLastScanMustConfirmNearlyHalfOfWhatBothShow)
{
    const ale_testimony_t seen = {30000000, 14000000, 0, false};
    const ale_testimony_t in_part = {30000000, 13000000, 0, false};
    const ale_testimony_t little = {1500000, 1500000, 0, true};
    EXPECT_TRUE(ale_tracking_witnesses(&seen));
    EXPECT_FALSE(ale_tracking_witnesses(&in_part));
    EXPECT_FALSE(ale_tracking_witnesses(&little))
        << "two scans that show less than two metres cannot be compared";
}

TEST(TrackingMonitor,
     WhatIsNotWhereAPoseOfLittleCertaintyPutsItIsNoNewPlaceButLostUnlessWheelsToldOrNothingIsMapped)
{
    struct {
        bool counted;
        bool mapped;
        int64_t shown_um;
        bool lost;
    } const cases[] = {
        {false, true, 5000000, true},  {true, true, 5000000, false}, {false, false, 5000000, false},
        {false, true, 1000000, false}, {true, true, 1000000, false},
    };
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    fit.motion.cov.m[2][2] = int64_t{200000} * 200000;
    const ale_visibility_counts_t none = {0, 0};
    for (const auto &c : cases) {
        ale_tracking_monitor_t t;
        ale_tracking_init(&t);
        fit.shown_um = c.shown_um;
        ale_tracking_notice(&t, nullptr, c.counted, c.mapped);
        EXPECT_EQ(ale_tracking_may_reanchor(&t, &fit), c.shown_um > 2000000 && !c.lost);
        EXPECT_EQ(ale_tracking_judge(&t, &fit, &none, false), c.lost ? ALE_STATE_LOST : ALE_STATE_WEAK);
    }
}

TEST(TrackingMonitor, APositionThatMayBeAnywhereIsNoLossWhileAnotherPoseWaitsForTheNextScan)
{
    const ale_visibility_counts_t none = {0, 0};
    const ale_visibility_counts_t violated = {0, 12};
    ale_fit_t fit = {};
    ale_motion_init(&fit.motion, 0, {0, 0, 0}, 1, 1);
    fit.motion.cov.m[0][0] = square(2 * metre_um);
    ale_tracking_monitor_t t;
    ale_tracking_init(&t);
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &none, true), ALE_STATE_WEAK);
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &none, false), ALE_STATE_LOST);
    ale_tracking_init(&t);
    for (int k = 0; k < 7; k++) {
        EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated, true), ALE_STATE_WEAK);
    }
    EXPECT_EQ(ale_tracking_judge(&t, &fit, &violated, true), ALE_STATE_LOST);
}

} // namespace
