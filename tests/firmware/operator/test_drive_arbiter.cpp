#include <gtest/gtest.h>

#include <string>

extern "C" {
#include "operator/drive_arbiter.h"
}

namespace
{

constexpr int64_t kStart = 1000000000;

class DriveDesk : public testing::Test
{
  protected:
    ale_desk_answer_t drive(const char *name, int64_t at_us)
    {
        return ale_drive_desk_drive(&desk, name, 300000, -200000, kStart + at_us);
    }
    std::string holder(int64_t at_us)
    {
        return ale_drive_desk_holder(&desk, kStart + at_us);
    }
    ale_drive_desk_t desk{};
};

TEST_F(DriveDesk, AtFirstNobodyDrives)
{
    EXPECT_EQ(holder(0), "");
    EXPECT_EQ(desk.wish.valid_until_us, 0);
}

TEST_F(DriveDesk, AWishIsValidForTheDeadMansTime)
{
    EXPECT_EQ(drive("alice", 0), ALE_DESK_HIS);
    EXPECT_EQ(desk.wish.v_um_s, 300000);
    EXPECT_EQ(desk.wish.w_urad_s, -200000);
    EXPECT_EQ(desk.wish.valid_until_us, kStart + 300000);
    EXPECT_EQ(drive("alice", 200000), ALE_DESK_HIS);
    EXPECT_EQ(desk.wish.valid_until_us, kStart + 500000);
}

TEST_F(DriveDesk, OneOperatorDrivesUntilHeHasNotForAWhile)
{
    EXPECT_EQ(drive("alice", 0), ALE_DESK_HIS);
    EXPECT_EQ(drive("bob", 1000), ALE_DESK_TAKEN);
    EXPECT_EQ(holder(1999999), "alice");
    EXPECT_EQ(drive("bob", 1999999), ALE_DESK_TAKEN);
    EXPECT_EQ(desk.wish.valid_until_us, kStart + 300000) << "a refused wish changes nothing";
    EXPECT_EQ(holder(2000000), "");
    EXPECT_EQ(drive("bob", 2000000), ALE_DESK_HIS);
    EXPECT_EQ(holder(2000000), "bob");
}

TEST_F(DriveDesk, AStopTakesTheWishAndTheDesk)
{
    EXPECT_EQ(drive("alice", 0), ALE_DESK_HIS);
    ale_drive_desk_stop(&desk, kStart + 1000);
    EXPECT_EQ(desk.wish.valid_until_us, 0);
    EXPECT_EQ(holder(1000), "");
}

TEST_F(DriveDesk, AfterAStopAStickThatIsStillHeldDoesNotDrive)
{
    EXPECT_EQ(drive("alice", 0), ALE_DESK_HIS);
    ale_drive_desk_stop(&desk, kStart + 50000);
    for (int64_t at = 100000; at < 3000000; at += 100000) {
        EXPECT_EQ(drive("alice", at), ALE_DESK_STOPPED);
        EXPECT_EQ(desk.wish.valid_until_us, 0);
    }
    EXPECT_EQ(drive("alice", 2900000 + 300000), ALE_DESK_HIS) << "let go, and asked again";
}

} // namespace
