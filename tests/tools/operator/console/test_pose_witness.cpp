// Poses that were heard against those that the robot vouches for.
#include "operator/console/pose_witness.h"

#include <gtest/gtest.h>

using console::PoseWitness;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace
{

/* Digest of the robot's own pose of a scan; a forged one has another. */
int64_t own(int32_t scan)
{
    return scan * 1000003LL;
}

ale::vouched_t vouched(int32_t first, int32_t last)
{
    ale::vouched_t message{};
    for (int32_t scan = first; scan <= last; scan++) {
        message.pose_scan.push_back(scan);
        message.pose_digest.push_back(own(scan));
    }
    message.num_poses = static_cast<int32_t>(message.pose_scan.size());
    return message;
}

class Witness : public testing::Test
{
  protected:
    void hear(int32_t first, int32_t last)
    {
        for (int32_t scan = first; scan <= last; scan++) {
            witness.heard(scan, own(scan), now);
        }
    }
    PoseWitness witness;
    PoseWitness::Clock::time_point now{seconds(1000)};
};

} // namespace

TEST_F(Witness, TheRobotsOwnPosesAreNoAlarm)
{
    hear(0, 40);
    EXPECT_EQ(witness.compare(vouched(10, 35), now), 0U) << "some are older, some were not vouched for yet";
    EXPECT_EQ(witness.compare(vouched(20, 45), now + seconds(1)), 0U);
    EXPECT_FALSE(witness.is_alarmed(now));
}

TEST_F(Witness, APoseInThePlaceOfATrueOneIsForged)
{
    hear(0, 20);
    witness.heard(15, 7, now);
    EXPECT_EQ(witness.compare(vouched(0, 20), now), 1U);
    EXPECT_EQ(witness.compare(vouched(0, 20), now), 0U) << "told once";
    EXPECT_TRUE(witness.is_alarmed(now + seconds(9)));
    EXPECT_FALSE(witness.is_alarmed(now + seconds(11)));
}

TEST_F(Witness, OnesThatAreNumberedAheadAreFoundOutWhenTheRobotGetsThere)
{
    for (int32_t scan = 0; scan < 10; scan++) {
        witness.heard(scan + 6, 7, now);
    }
    EXPECT_EQ(witness.compare(vouched(0, 9), now), 4U);
    EXPECT_EQ(witness.compare(vouched(0, 19), now + seconds(1)), 6U);
}

TEST_F(Witness, OnesThatTheRobotNeverReachesAreForged)
{
    witness.heard(100000, 7, now);
    EXPECT_EQ(witness.compare(vouched(0, 9), now + seconds(2)), 0U);
    EXPECT_EQ(witness.compare(vouched(0, 39), now + milliseconds(3001)), 1U);
    witness.heard(5, 7, now);
    EXPECT_EQ(witness.compare(vouched(400, 431), now), 1U) << "nor those of long ago";
    EXPECT_EQ(witness.forged(), 2U);
}

TEST_F(Witness, AFloodDoesNotHideAForgedOne)
{
    hear(0, 20);
    EXPECT_EQ(witness.compare(vouched(0, 20), now), 0U);
    witness.heard(25, 7, now);
    for (int k = 0; k < 600; k++) {
        witness.heard(3, own(3), now); /* its own, played again */
    }
    hear(21, 30);
    EXPECT_GT(witness.compare(vouched(10, 30), now + seconds(1)), 0U);
    EXPECT_TRUE(witness.is_alarmed(now + seconds(1)));
}

TEST_F(Witness, AsManyInALongerTimeAreNoFlood)
{
    for (int k = 0; k < 600; k++) {
        witness.heard(3, own(3), now + milliseconds(10) * k);
    }
    EXPECT_EQ(witness.compare(vouched(0, 20), now + seconds(6)), 0U);
}

TEST_F(Witness, WhileAlarmedNumbersThatTheRobotCannotHaveReachedAreBeyond)
{
    auto word = vouched(0, 20);
    word.status.scan_rate_hz = 10;
    word.clock_ppm = 1000000;
    EXPECT_EQ(witness.compare(word, now), 0U);
    EXPECT_FALSE(witness.is_beyond(1000, now)) << "no alarm: whatever comes is shown";
    witness.heard(15, 7, now);
    EXPECT_EQ(witness.compare(word, now), 1U);
    EXPECT_FALSE(witness.is_beyond(21, now));
    EXPECT_TRUE(witness.is_beyond(26, now));
    EXPECT_FALSE(witness.is_beyond(26, now + milliseconds(400)));
    auto late = vouched(0, 25);
    late.status.scan_rate_hz = 10;
    late.clock_ppm = 1000000;
    EXPECT_EQ(witness.compare(late, now + seconds(1)), 0U);
    EXPECT_FALSE(witness.is_beyond(31, now + seconds(1))) << "the word was held up, not the robot";
}
