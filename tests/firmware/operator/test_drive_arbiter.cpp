#include <gtest/gtest.h>

#include <string>

extern "C" {
#include "operator/drive_arbiter.h"
}

namespace
{

constexpr int64_t kStart = 1000000000;

class DriveArbiter : public testing::Test
{
  protected:
    ale_arbiter_answer_t drive(const char *name, int64_t at_us)
    {
        return ale_drive_arbiter_drive(&arbiter, name, 300000, -200000, kStart + at_us);
    }
    std::string holder(int64_t at_us)
    {
        return ale_drive_arbiter_holder(&arbiter, kStart + at_us);
    }
    ale_drive_arbiter_t arbiter{};
};

TEST_F(DriveArbiter, AtFirstNobodyDrives)
{
    EXPECT_EQ(holder(0), "");
    EXPECT_EQ(arbiter.request.valid_until_us, 0);
}

TEST_F(DriveArbiter, ARequestIsValidForTheDeadMansTime)
{
    EXPECT_EQ(drive("alice", 0), ALE_ARBITER_GRANTED);
    EXPECT_EQ(arbiter.request.v_um_s, 300000);
    EXPECT_EQ(arbiter.request.w_urad_s, -200000);
    EXPECT_EQ(arbiter.request.valid_until_us, kStart + 300000);
    EXPECT_EQ(drive("alice", 200000), ALE_ARBITER_GRANTED);
    EXPECT_EQ(arbiter.request.valid_until_us, kStart + 500000);
}

TEST_F(DriveArbiter, OneOperatorDrivesUntilHeHasNotForAWhile)
{
    EXPECT_EQ(drive("alice", 0), ALE_ARBITER_GRANTED);
    EXPECT_EQ(drive("bob", 1000), ALE_ARBITER_TAKEN);
    EXPECT_EQ(holder(1999999), "alice");
    EXPECT_EQ(drive("bob", 1999999), ALE_ARBITER_TAKEN);
    EXPECT_EQ(arbiter.request.valid_until_us, kStart + 300000) << "a refused request changes nothing";
    EXPECT_EQ(holder(2000000), "");
    EXPECT_EQ(drive("bob", 2000000), ALE_ARBITER_GRANTED);
    EXPECT_EQ(holder(2000000), "bob");
}

TEST_F(DriveArbiter, AStopTakesTheRequestAndTheHold)
{
    EXPECT_EQ(drive("alice", 0), ALE_ARBITER_GRANTED);
    ale_drive_arbiter_stop(&arbiter, kStart + 1000);
    EXPECT_EQ(arbiter.request.valid_until_us, 0);
    EXPECT_EQ(holder(1000), "");
}

TEST_F(DriveArbiter, AfterAStopAStickThatIsStillHeldDoesNotDrive)
{
    EXPECT_EQ(drive("alice", 0), ALE_ARBITER_GRANTED);
    ale_drive_arbiter_stop(&arbiter, kStart + 50000);
    for (int64_t at = 100000; at < 3000000; at += 100000) {
        EXPECT_EQ(drive("alice", at), ALE_ARBITER_STOPPED);
        EXPECT_EQ(arbiter.request.valid_until_us, 0);
    }
    EXPECT_EQ(drive("alice", 2900000 + 300000), ALE_ARBITER_GRANTED) << "let go, and asked again";
}

} // namespace
