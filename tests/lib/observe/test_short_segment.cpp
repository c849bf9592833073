// lib/observe/short_segment.c: short segments and point features of the beams that are in no line. Twin: mean
// and principal axis of the same points in double.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "observe/short_segment.h"
}

namespace
{
using reference::pi;

constexpr double own_direction_urad = 150000;

struct ShortSegment : testing::Test {
    std::unique_ptr<ale_features_t> features = std::make_unique<ale_features_t>();
    std::unique_ptr<ale_segment_workspace_t> memory = std::make_unique<ale_segment_workspace_t>();
    std::unique_ptr<ale_scan_t> scan = std::make_unique<ale_scan_t>();

    void take(const std::vector<room::Wall> &surfaces, double noise = 0)
    {
        std::mt19937 rng(5);
        room::Sensor sensor;
        sensor.beam_time_ns = 0;
        sensor.noise = noise;
        *scan = room::scan_at(
            surfaces, sensor, [](double) { return reference::Pose(0, 0, 0); }, 1, rng);
    }
    std::vector<ale_observation_t> observe(uint32_t room = 200, ale_pose_t sensor = {0, 0, 0})
    {
        const ale_noise_t noise = ale_noise_default();
        const ale_posed_scan_t from = {scan.get(), nullptr, sensor};
        std::vector<ale_observation_t> out(room);
        out.resize(ale_observe_segments(features.get(), &from, &noise, memory.get(), room, out.data()));
        return out;
    }
    Eigen::Vector2d point(int beam) const
    {
        const double a = convert::radians(ale_scan_bearing(scan.get(), beam));
        return scan->range_um[beam] * 1e-6 * Eigen::Vector2d(std::cos(a), std::sin(a));
    }
};

/* As no scanner makes them: ten beams in a turn, and echoes at the end of its reach. */
TEST_F(ShortSegment, PointsThatAreTensOfMetresApartHaveNoDirectionOfTheirOwn)
{
    scan->beams = 6;
    scan->step_bam = static_cast<int32_t>(UINT32_MAX / 10);
    for (int k = 0; k < scan->beams; k++) {
        scan->flag[k] = ALE_BEAM_VALID;
        scan->range_um[k] = ALE_MAX_RANGE_UM;
    }
    const std::vector<ale_observation_t> all = observe();
    ASSERT_FALSE(all.empty());
    for (const ale_observation_t &o : all) {
        EXPECT_GT(static_cast<double>(o.var_angle_urad2), own_direction_urad * own_direction_urad);
    }
}

TEST_F(ShortSegment, CentreAndNormalAreThoseOfItsPoints)
{
    take({{-2, 3, 2, 2}, {3, -1, 2.5, 2}, {-1, -2, 2, -1.5}}, 0.002);
    int with_direction = 0;
    for (const ale_observation_t &o : observe()) {
        const int n = o.last_beam - o.first_beam + 1;
        ASSERT_GE(n, 2);
        ASSERT_LE(n, 6);
        Eigen::Vector2d mean(0, 0);
        for (int k = o.first_beam; k <= o.last_beam; k++) {
            mean += point(k) / n;
        }
        EXPECT_NEAR(o.centre.x_um, mean[0] * 1e6, 5);
        EXPECT_NEAR(o.centre.y_um, mean[1] * 1e6, 5);
        const Eigen::Vector2d normal(std::cos(convert::radians(o.normal_bam)),
                                     std::sin(convert::radians(o.normal_bam)));
        EXPECT_LT(normal.dot(mean), 0) << "towards the sensor";
        Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
        for (int k = o.first_beam; k <= o.last_beam; k++) {
            moments += (point(k) - mean) * (point(k) - mean).transpose();
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moments);
        if (static_cast<double>(o.var_angle_urad2) <= own_direction_urad * own_direction_urad) {
            EXPECT_GT(std::abs(normal.dot(axes.eigenvectors().col(0))), std::cos(0.002));
            with_direction++;
        } else {
            EXPECT_LT(normal.dot(mean.normalized()), -std::cos(0.001))
                << "none of its own: towards the sensor";
        }
    }
    EXPECT_GT(with_direction, 20);
}

TEST_F(ShortSegment, ARunIsCutIntoPartsOfSixBeamsAtMostThatLeaveNoneOut)
{
    take({{2, -0.2, 2, 0.2}});
    const auto segments = observe();
    ASSERT_EQ(segments.size(), 6U);
    for (size_t i = 1; i < segments.size(); i++) {
        EXPECT_EQ(segments[i].first_beam, segments[i - 1].last_beam + 1);
        EXPECT_EQ(segments[i].kind, ALE_OBSERVATION_SEGMENT);
    }
    EXPECT_NEAR(point(segments.front().first_beam)[1], -0.2, 0.013);
    EXPECT_NEAR(point(segments.back().last_beam)[1], 0.2, 0.013);
}

TEST_F(ShortSegment, BeamsOfALineAreLeftOut)
{
    take({{2, -0.2, 2, 0.2}});
    features->line_count = 1;
    features->line[0].first = observe().front().first_beam;
    features->line[0].last = observe().back().last_beam;
    EXPECT_TRUE(observe().empty());
}

TEST_F(ShortSegment, ASmallThingWithNothingNearBesideItIsAPointFeature)
{
    const room::Wall leg = {2, -0.03, 2, 0.03};
    take({leg, {4, -3, 4, 3}});
    const auto count_points = [](const std::vector<ale_observation_t> &all) {
        return std::count_if(all.begin(), all.end(),
                             [](const ale_observation_t &o) { return o.kind == ALE_OBSERVATION_POINT; });
    };
    EXPECT_EQ(count_points(observe()), 1);
    take({leg});
    EXPECT_EQ(count_points(observe()), 1) << "nothing at all beside it";
    take({leg, {2.08, -3, 2.08, 3}});
    EXPECT_EQ(count_points(observe()), 0) << "the wall behind it is too near";
    take({{2, -0.1, 2, 0.1}, {4, -3, 4, 3}});
    EXPECT_EQ(count_points(observe()), 0) << "too large";
}

TEST_F(ShortSegment, ARunGoesOnOverMissingEchoesWhereManyAreMissing)
{
    take({{2, -0.2, 2, 0.2}});
    const size_t of_all = observe().size();
    const int middle = scan->beams / 2;
    ale_scan_set_range(scan.get(), static_cast<uint16_t>(middle), 0);
    for (const ale_observation_t &o : observe()) {
        EXPECT_TRUE(o.last_beam < middle || o.first_beam > middle) << "one is missing: the run ends";
    }
    for (uint16_t k = 0; k < scan->beams; k += 2) {
        ale_scan_set_range(scan.get(), k, 0);
    }
    const auto of_half = observe();
    EXPECT_EQ(of_half.size(), (of_all + 1) / 2);
    EXPECT_NEAR(point(of_half.front().first_beam)[1], -0.2, 0.025);
    EXPECT_NEAR(point(of_half.back().last_beam)[1], 0.2, 0.025);
    for (const ale_observation_t &o : of_half) {
        EXPECT_EQ(o.kind, ALE_OBSERVATION_SEGMENT) << "missing echoes beside it make no point of it";
        EXPECT_NEAR(o.centre.x_um, 2000000, 10);
    }
}

TEST_F(ShortSegment, AStepInRangeEndsARunAndSingleBeamsAreLeftOut)
{
    take({{2, 0, 2, 0.3}, {2.2, -0.3, 2.2, 0}});
    for (const ale_observation_t &o : observe()) {
        EXPECT_LT(std::abs(scan->range_um[o.first_beam] - scan->range_um[o.last_beam]), 30000);
    }
    take({});
    ale_scan_set_range(scan.get(), 100, 2000000);
    ale_scan_set_range(scan.get(), 300, 3000000);
    EXPECT_TRUE(observe().empty());
}

TEST_F(ShortSegment, WhereThereIsNoRoomForAllAnEvenChoiceIsMade)
{
    take({{2, -2, 2, 2}});
    const auto all = observe();
    const auto some = observe(5);
    ASSERT_EQ(some.size(), 5U);
    const int share = static_cast<int>(all.size()) / 5;
    for (size_t i = 1; i < some.size(); i++) {
        EXPECT_NEAR(some[i].first_beam - some[i - 1].first_beam, share * 6, 12);
    }
}

TEST_F(ShortSegment, TheSensorsPosePlacesThemInTheRobotsFrame)
{
    take({{2, -0.2, 2, 0.2}});
    const ale_pose_t mounted = convert::pose(reference::Pose(0.1, -0.05, 0.7));
    const auto own = observe();
    const auto placed = observe(200, mounted);
    ASSERT_EQ(own.size(), placed.size());
    for (size_t i = 0; i < own.size(); i++) {
        const ale_point_t centre = ale_pose_apply(mounted, own[i].centre);
        EXPECT_NEAR(placed[i].centre.x_um, centre.x_um, 2);
        EXPECT_NEAR(placed[i].centre.y_um, centre.y_um, 2);
        EXPECT_EQ(placed[i].normal_bam, own[i].normal_bam + mounted.theta_bam);
    }
}
} // namespace
