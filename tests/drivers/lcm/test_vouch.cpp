/* What a robot vouches for: its status and the newest poses, as the other side finds them. */
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "ale/vouched_t.hpp"
#include "drivers/command/signed_command.hpp"

extern "C" {
#include "command/vouched.h"
#include "lcm/vouch.h"
}

namespace
{

class Vouch : public testing::Test
{
  protected:
    Vouch()
    {
        vouch.key = &rover.secret;
        vouch.clock_ppm = 1000000;
        status.utime = 77;
        status.boot = 4711;
        for (char **text :
             {&status.realtime_detail, &status.driver_state, &status.device, &status.robot,
              &status.who_drives, &status.exploration, &status.command_operator, &status.command_result}) {
            *text = name;
        }
    }
    ale::vouched_t said()
    {
        const int count = ale_vouch_encode(&vouch, &status, bytes, sizeof bytes);
        const ale_keys_t robots = signed_command::keys_of({rover});
        EXPECT_TRUE(ale_is_vouched(&robots, bytes, static_cast<size_t>(count)));
        ale::vouched_t message;
        EXPECT_EQ(message.decode(bytes, 0, count), count);
        return message;
    }

    char name[8] = "rover";
    const signed_command::Operator rover{"rover"};
    ale_vouch_t vouch{};
    lcmtypes_ale_status_t status{};
    uint8_t bytes[4096];
};

TEST_F(Vouch, SaysTheStatusSignedWithACounterThatGrows)
{
    const ale::vouched_t first = said();
    const ale::vouched_t second = said();
    EXPECT_EQ(first.status.robot, "rover");
    EXPECT_EQ(first.boot, 4711);
    EXPECT_EQ(first.utime, 77);
    EXPECT_EQ(first.num_poses, 0);
    EXPECT_EQ(second.counter, first.counter + 1);
    EXPECT_EQ(first.key, ale_vouched_key(&rover.known));
}

TEST_F(Vouch, KeepsTheNewestPoses)
{
    for (int32_t scan = 0; scan < 100; scan++) {
        const auto pose = static_cast<uint8_t>(scan);
        ale_vouch_pose(&vouch, scan, &pose, 1);
    }
    const ale::vouched_t message = said();
    ASSERT_EQ(message.num_poses, int{ALE_VOUCHED_POSES});
    std::vector<bool> seen(100);
    for (size_t k = 0; k < message.pose_scan.size(); k++) {
        const auto pose = static_cast<uint8_t>(message.pose_scan[k]);
        EXPECT_EQ(message.pose_digest[k], ale_digest(&pose, 1));
        seen[pose] = true;
    }
    for (size_t scan = 100 - ALE_VOUCHED_POSES; scan < 100; scan++) {
        EXPECT_TRUE(seen[scan]) << scan;
    }
}

TEST_F(Vouch, WhatDoesNotFitIsNotSaid)
{
    EXPECT_LT(ale_vouch_encode(&vouch, &status, bytes, 100), 0);
}

} // namespace
