// lib/map/landmarks.c: a hashed table of point landmarks.
#include <memory>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "map/landmarks.h"
}

namespace
{
struct Landmarks : testing::Test {
    std::unique_ptr<ale_landmarks_t> landmarks = std::make_unique<ale_landmarks_t>();
    void SetUp() override
    {
        ale_landmarks_clear(landmarks.get());
    }
};

TEST_F(Landmarks, AreFoundByPositionAndNormalAndAveraged)
{
    ale_landmarks_add(landmarks.get(), &(const ale_landmark_t &)ale_landmark_t{
                                           {1000000, -50000}, convert::bam(0), 1, 9000000, 1, 0, 0, 0});
    EXPECT_EQ(ale_landmarks_find(landmarks.get(), {1200000, -50000}, 0, false, 100000), ALE_NO_LANDMARK);
    EXPECT_EQ(ale_landmarks_find(landmarks.get(), {1020000, -60000}, convert::bam(2), false, 100000),
              ALE_NO_LANDMARK);
    const int32_t found =
        ale_landmarks_find(landmarks.get(), {1020000, -60000}, convert::bam(0.3), false, 100000);
    ASSERT_NE(found, ALE_NO_LANDMARK);
    ale_landmark_observe(&landmarks->landmark[found], {1020000, -50000}, convert::bam(0), 9000000, 2);
    EXPECT_NEAR(landmarks->landmark[found].p.x_um, 1010000, 1);
    EXPECT_EQ(landmarks->landmark[found].seen, 2);
}

TEST_F(Landmarks, AFullSetReplacesTheLeastSeen)
{
    for (uint16_t i = 0; i < ALE_LANDMARK_WAYS + 1; i++) {
        ale_landmark_t m = {};
        m.p = {10000 + 1000 * i, 10000};
        m.seen = static_cast<uint16_t>(i == 2 ? 1 : 9);
        m.var_um2 = 9000000;
        m.is_point = 1;
        ale_landmarks_add(landmarks.get(), &m);
    }
    EXPECT_EQ(ale_landmarks_find(landmarks.get(), {12000, 10000}, 0, true, 500), ALE_NO_LANDMARK);
    EXPECT_NE(ale_landmarks_find(landmarks.get(), {14000, 10000}, 0, true, 500), ALE_NO_LANDMARK);
}

TEST_F(Landmarks, PointFeaturesFaceEverywhereSurfacesDoNot)
{
    ale_landmark_t post = {{0, 0}, 0, 1, 9000000, 1, 1, 0, 0};
    ale_landmarks_add(landmarks.get(), &post);
    EXPECT_NE(ale_landmarks_find(landmarks.get(), {0, 0}, convert::bam(3), true, 50000), ALE_NO_LANDMARK);
    EXPECT_EQ(ale_landmarks_find(landmarks.get(), {0, 0}, convert::bam(3), false, 50000), ALE_NO_LANDMARK);
    EXPECT_NE(ale_landmarks_find(landmarks.get(), {0, 0}, convert::bam(0.5), false, 50000), ALE_NO_LANDMARK);
}

TEST_F(Landmarks, TheNearestIsFoundAcrossTheBordersOfCellsAndOfQuadrants)
{
    for (const int32_t x_um : {-99000, -1000, 1000, 99000}) {
        ale_landmark_t surface = {{x_um, 5}, 0, 1, 9000000, 1, 0, 0, 0};
        ale_landmarks_add(landmarks.get(), &surface);
    }
    for (const int32_t x_um : {-120000, -20000, 30000, 101000}) {
        const int32_t found = ale_landmarks_find(landmarks.get(), {x_um, 0}, 0, false, 100000);
        ASSERT_NE(found, ALE_NO_LANDMARK);
        int32_t nearest_um = 1000;
        for (const int32_t at_um : {-99000, -1000, 99000}) {
            nearest_um = std::abs(at_um - x_um) < std::abs(nearest_um - x_um) ? at_um : nearest_um;
        }
        EXPECT_EQ(landmarks->landmark[found].p.x_um, nearest_um);
    }
}

TEST_F(Landmarks, TheVarianceFallsWithEveryObservationToItsFloor)
{
    ale_landmark_t landmark = {{0, 0}, 0, 1, 100000000, 1, 0, 3, 0};
    ale_landmark_observe(&landmark, {10000, 0}, 0, 100000000, 2);
    EXPECT_NEAR(static_cast<double>(landmark.var_um2), 50e6, 1);
    EXPECT_EQ(landmark.last_scan, 2U);
    for (uint32_t scan = 3; scan < 100; scan++) {
        ale_landmark_observe(&landmark, {10000, 0}, 0, 100000000, scan);
    }
    EXPECT_EQ(landmark.var_um2, 9000000);
    EXPECT_NEAR(landmark.p.x_um, 10000, 1000);
}
} // namespace
