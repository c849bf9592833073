// lib/match/scan_to_scan.c: where the last scan says that this one was taken.
#include "lib/observe/look.h"

extern "C" {
#include "match/scan_to_scan.h"
}

using room::Look;

namespace
{
ale_pose_t found(const std::vector<room::Wall> &walls, const reference::Pose &before,
                 const reference::Pose &now, const reference::Pose &guess, bool *any)
{
    const Look first(walls, before, before);
    const Look second(walls, now, now);
    const auto memory = std::make_unique<ale_scan_match_t>();
    ale_pose_t pose = convert::pose(guess);
    *any = ale_match_scans(memory.get(), {first.seen.observation, first.seen.observation_count},
                           {second.seen.observation, second.seen.observation_count}, 1000000, 400000, &pose);
    return pose;
}
} // namespace

TEST(Registration, FindsTheWayBetweenTwoScansFromAPoorGuess)
{
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    int right = 0;
    for (int k = 0; k < 60; k++) {
        const reference::Pose before(0.6 + 0.6 * unit(rng), 0.2 + 0.8 * unit(rng), 3 * unit(rng));
        const reference::Pose way(0.5 * unit(rng), 0.2 * unit(rng), 0.5 * unit(rng));
        const reference::Pose off(0.5 * unit(rng), 0.5 * unit(rng), 0.3 * unit(rng));
        bool any = false;
        const ale_pose_t got =
            found(room::l_shape(), before, reference::compose(before, way), way + off, &any);
        const reference::Pose error = convert::pose(got) - way;
        right += any && error.head<2>().norm() < 0.25 && std::abs(reference::wrap(error[2])) < 0.06;
    }
    EXPECT_GE(right, 57);
}

TEST(Registration, AlongACorridorTheGuessStands)
{
    const std::vector<room::Wall> corridor = {{-20, -1, 20, -1}, {20, 1.2, -20, 1.2}};
    bool any = false;
    const ale_pose_t got = found(corridor, {0, 0, 0}, {0.5, 0.3, 0.2}, {0.35, 0, 0}, &any);
    ASSERT_TRUE(any);
    EXPECT_NEAR(convert::pose(got)[0], 0.35, 0.13);
    EXPECT_NEAR(convert::pose(got)[1], 0.3, 0.13);
    EXPECT_NEAR(convert::pose(got)[2], 0.2, 0.06);
}

TEST(Registration, WithoutAnythingInCommonTheGuessIsUntouched)
{
    bool any = true;
    const Look first({{2, -2, 2, 2}}, {0, 0, 0}, {0, 0, 0});
    const auto memory = std::make_unique<ale_scan_match_t>();
    ale_pose_t pose = {1, 2, 3};
    any = ale_match_scans(memory.get(), {first.seen.observation, first.seen.observation_count},
                          {first.seen.observation, 0}, 1000000, 400000, &pose);
    EXPECT_FALSE(any);
    EXPECT_EQ(pose.x_um, 1);
    EXPECT_EQ(pose.theta_bam, 3u);
}
