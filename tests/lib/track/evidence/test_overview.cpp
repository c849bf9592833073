// lib/track/evidence/overview.c: which scan is kept.
#include "lib/observe/look.h"

extern "C" {
#include "track/evidence/overview.h"
}

namespace
{

const reference::Pose origin(0, 0, 0);

class Overview : public ::testing::Test
{
  protected:
    Overview()
    {
        ale_overview_clear(&overview);
    }

    ale_overview_t overview = {};
    room::Look room{room::l_shape(), origin, origin};
    room::Look corner{{{1, -0.3, 1, 0.3}}, origin, origin};
};

TEST_F(Overview, IsTheLastScanThatShowsNoLessThanHalfAsMuch)
{
    EXPECT_FALSE(ale_overview_is_richer(&overview, corner.seen.observation, corner.seen.observation_count));
    ale_overview_keep(&overview, &corner.seen, 0);
    EXPECT_EQ(overview.observation_count, corner.seen.observation_count);
    ale_overview_keep(&overview, &room.seen, 100000);
    EXPECT_EQ(overview.observation_count, room.seen.observation_count);
    ale_overview_keep(&overview, &corner.seen, 200000);
    EXPECT_EQ(overview.observation_count, room.seen.observation_count);
    EXPECT_TRUE(ale_overview_is_richer(&overview, corner.seen.observation, corner.seen.observation_count));
    EXPECT_FALSE(ale_overview_is_richer(&overview, room.seen.observation, room.seen.observation_count));
}

TEST_F(Overview, GivesWayToAnyAfterTwoSecondsOrHalfAMetreOrHalfARadian)
{
    ale_seen_t later = corner.seen;
    const auto is_kept = [&](ale_pose_t robot, int64_t stamp_us) {
        ale_overview_clear(&overview);
        ale_overview_keep(&overview, &room.seen, 1000000);
        later.robot = robot;
        ale_overview_keep(&overview, &later, stamp_us);
        return overview.shown_um > 5000000;
    };
    EXPECT_TRUE(is_kept(convert::pose(reference::Pose(0.45, -0.45, 0.45)), 2900000));
    EXPECT_FALSE(is_kept(convert::pose(reference::Pose(0.55, 0, 0)), 1100000));
    EXPECT_FALSE(is_kept(convert::pose(reference::Pose(0, -0.55, 0)), 1100000));
    EXPECT_FALSE(is_kept(convert::pose(reference::Pose(0, 0, -0.55)), 1100000));
    EXPECT_FALSE(is_kept(convert::pose(reference::Pose(0, 0, 0)), 3100000));
}

} // namespace
