/* What the motor side takes, against the robot's side and against whoever listens, records and plays again.
 */
#include <gtest/gtest.h>
#include <sodium.h>

#include <array>
#include <cstring>
#include <vector>

extern "C" {
#include "lcmtypes_ale_drive_keyed_t.h"
#include "lcmtypes_ale_drive_ready_t.h"
#include "motor/receiver.h"
#include "motor/set_point.h"
}

namespace
{

using Message = std::array<uint8_t, ALE_MOTOR_MESSAGE>;

class Motor : public testing::Test
{
  protected:
    void SetUp() override
    {
        ASSERT_EQ(ale_drive_key_make(&key), 0);
        start_motor(0x1122334455667788);
        point.boot = 4711;
        point.utime = 1700000000000000;
    }
    void start_motor(uint64_t random)
    {
        motor = {};
        motor.next = random;
        std::memcpy(motor.key, key.key, sizeof key.key);
    }
    Message message(const ale_keyed_set_point_t &of) const
    {
        Message bytes;
        ale_set_point_message(&of, &key, bytes.data());
        return bytes;
    }
    /* The robot's next set point, 40 ms after the last. */
    Message next(int32_t v_um_s = 200000)
    {
        point.counter++;
        point.utime += 40000;
        now_ms += 40;
        point.v_um_s = v_um_s;
        return message(point);
    }
    bool take(const Message &bytes)
    {
        return ale_motor_take(&motor, bytes.data(), bytes.size(), now_ms);
    }
    /* The motor side says for what it is ready, and the robot hears it. */
    bool tell()
    {
        uint8_t bytes[ALE_MOTOR_READY];
        const size_t count = ale_motor_ready(&motor, bytes);
        return ale_set_point_ready(bytes, count, &key, point.boot, &point.nonce);
    }
    /* So many of the robot's, as somebody hears them who listens; all are taken. */
    std::vector<Message> taken(int count)
    {
        std::vector<Message> heard;
        for (int k = 0; k < count; k++) {
            heard.push_back(next());
            EXPECT_TRUE(take(heard.back()));
        }
        return heard;
    }
    void none_is_taken(const std::vector<Message> &old, const char *why = "")
    {
        for (const Message &message : old) {
            EXPECT_FALSE(take(message)) << why;
        }
    }
    /* From a first message to one that is taken. */
    void meet()
    {
        EXPECT_FALSE(take(next())) << "made for no start of the motor side";
        ASSERT_TRUE(tell());
        ASSERT_TRUE(take(next()));
    }
    int32_t speed()
    {
        int32_t v = 1;
        int32_t w = 1;
        ale_motor_set_point(&motor, now_ms, &v, &w);
        return v;
    }

    ale_drive_key_t key{};
    ale_motor_t motor{};
    ale_keyed_set_point_t point{};
    uint32_t now_ms = 0xffffff00; /* about to wrap */
};

TEST_F(Motor, TheTagIsLibsodiumsSipHash)
{
    std::vector<uint8_t> bytes(70);
    randombytes_buf(bytes.data(), bytes.size());
    for (size_t count = 0; count < bytes.size(); count++) {
        uint64_t expected = 0;
        crypto_shorthash(reinterpret_cast<uint8_t *>(&expected), bytes.data(), count, key.key);
        const uint64_t got = ale_siphash(key.key, bytes.data(), count);
        uint8_t little[8];
        for (int k = 0; k < 8; k++) {
            little[k] = static_cast<uint8_t>(got >> (8 * k));
        }
        EXPECT_EQ(std::memcmp(little, &expected, 8), 0) << count;
    }
}

TEST_F(Motor, ObeysWhoHasTheKeyOnceBothKnowEachOther)
{
    meet();
    EXPECT_EQ(speed(), 200000);
    for (int k = 0; k < 100; k++) {
        ASSERT_TRUE(take(next(1000 * k)));
        EXPECT_EQ(speed(), 1000 * k);
    }
}

TEST_F(Motor, ObeysNobodyWhileItHasNoKey)
{
    key = {};
    start_motor(7);
    EXPECT_FALSE(take(next()));
    point.nonce = 7;
    EXPECT_FALSE(take(next()));
    EXPECT_EQ(speed(), 0);
    key.key[ALE_DRIVE_KEY_BYTES - 1] = 1;
    start_motor(7);
    EXPECT_TRUE(take(next())) << "all else was right";
}

TEST_F(Motor, StandsAfter300MsOfSilence)
{
    meet();
    now_ms += 299;
    EXPECT_EQ(speed(), 200000);
    now_ms += 1;
    EXPECT_EQ(speed(), 0);
    now_ms -= 100;
    EXPECT_EQ(speed(), 0) << "and does not begin again by itself";
}

TEST_F(Motor, NoBitMayBeAnother)
{
    meet();
    const Message good = next();
    for (size_t bit = 0; bit < 8 * good.size(); bit++) {
        Message bad = good;
        bad[bit / 8] ^= static_cast<uint8_t>(1U << bit % 8);
        EXPECT_FALSE(take(bad)) << bit;
    }
    EXPECT_FALSE(ale_motor_take(&motor, good.data(), good.size() - 1, now_ms));
    EXPECT_TRUE(take(good));
}

TEST_F(Motor, WhatWasSaidBeforeIsNotSaidAgain)
{
    meet();
    const std::vector<Message> heard = taken(20);
    EXPECT_TRUE(take(next(0)));
    none_is_taken(heard);
    EXPECT_EQ(speed(), 0);
}

TEST_F(Motor, WhatWasHeldUpIsOfNoUse)
{
    meet();
    std::vector<Message> held;
    for (int k = 0; k < 10; k++) {
        held.push_back(next());
    }
    now_ms += 5000;
    none_is_taken(held);
    EXPECT_EQ(speed(), 0);
}

TEST_F(Motor, AClockThatDriftsIsFollowed)
{
    meet();
    for (int second = 0; second < 3600; second++) {
        for (int k = 0; k < 25; k++) {
            ASSERT_TRUE(take(next())) << second;
        }
        now_ms++;
    }
}

TEST_F(Motor, WhatIsHeldUpMoreAndMoreIsNoClockThatDrifts)
{
    meet();
    int taken_late = 0;
    for (int second = 0; second < 3600; second++) {
        taken_late = 0;
        for (int k = 0; k < 25; k++) {
            taken_late += take(next());
        }
        now_ms += 2;
    }
    EXPECT_EQ(taken_late, 0) << "0.2 %";
}

TEST_F(Motor, AfterItsOwnStartRecordedSetPointsMoveNothing)
{
    meet();
    const std::vector<Message> heard = taken(50);
    start_motor(0x99);
    none_is_taken(heard, "with the robot switched off");
    ASSERT_TRUE(tell());
    EXPECT_TRUE(take(next()));
}

TEST_F(Motor, AfterTheRobotsStartRecordedSetPointsOfTheOneBeforeMoveNothing)
{
    meet();
    const std::vector<Message> heard = taken(50);
    point = {};
    point.boot = 815;
    point.utime = 1000000; /* its clock was lost */
    meet();
    none_is_taken(heard);
    EXPECT_TRUE(take(next())) << "the robot itself is heard again";
    EXPECT_TRUE(tell());
}

TEST_F(Motor, AWordThatItIsReadyCountsForOneStartAndWithTheKey)
{
    EXPECT_FALSE(take(next()));
    uint8_t bytes[ALE_MOTOR_READY];
    const size_t count = ale_motor_ready(&motor, bytes);
    int64_t nonce = 0;
    EXPECT_FALSE(ale_set_point_ready(bytes, count, &key, point.boot + 1, &nonce));
    EXPECT_FALSE(ale_set_point_ready(bytes, count - 1, &key, point.boot, &nonce));
    for (size_t bit = 0; bit < 8 * count; bit++) {
        uint8_t bad[ALE_MOTOR_READY];
        std::memcpy(bad, bytes, count);
        bad[bit / 8] ^= static_cast<uint8_t>(1U << bit % 8);
        EXPECT_FALSE(ale_set_point_ready(bad, count, &key, point.boot, &nonce)) << bit;
    }
    EXPECT_EQ(nonce, 0);
    EXPECT_TRUE(ale_set_point_ready(bytes, count, &key, point.boot, &nonce));
    EXPECT_NE(nonce, 0);
}

TEST_F(Motor, BothMessagesHaveTheSizesOfTheirTypes)
{
    lcmtypes_ale_drive_keyed_t keyed{};
    lcmtypes_ale_drive_ready_t ready{};
    EXPECT_EQ(lcmtypes_ale_drive_keyed_t_encoded_size(&keyed), int{ALE_MOTOR_MESSAGE});
    EXPECT_EQ(lcmtypes_ale_drive_ready_t_encoded_size(&ready), int{ALE_MOTOR_READY});
    uint8_t bytes[ALE_MOTOR_READY];
    ale_motor_ready(&motor, bytes);
    EXPECT_GT(lcmtypes_ale_drive_ready_t_decode(bytes, 0, sizeof bytes, &ready), 0) << "its fingerprint";
}

} // namespace
