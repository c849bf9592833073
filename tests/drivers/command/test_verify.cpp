/* What a robot obeys and what it refuses; 10,000 hostile commands, none obeyed, all counted. */
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <numeric>
#include <random>

#include "ale/command_t.hpp"
#include "drivers/command/signed_command.hpp"

extern "C" {
#include "command/message.h"
}

using signed_command::boot;
using signed_command::drive;
using signed_command::now_utime;
using signed_command::Operator;
using signed_command::signed_by;

namespace
{

class Verify : public testing::Test
{
  protected:
    void SetUp() override
    {
        const ale_keys_t keys = signed_command::keys_of({bob, alice});
        ale_verifier_init(&verifier, &keys, "rover", boot);
    }
    ale_verdict_t verdict(const std::vector<uint8_t> &bytes, int64_t now = now_utime)
    {
        /* Of its own size on the heap, so that the sanitizer sees a look behind its end. */
        const std::unique_ptr<uint8_t[]> exact(new uint8_t[bytes.size()]);
        std::copy(bytes.begin(), bytes.end(), exact.get());
        return ale_verify(&verifier, exact.get(), bytes.size(), now, &command);
    }
    uint64_t counted() const
    {
        return std::accumulate(verifier.count, verifier.count + ALE_VERDICTS, uint64_t{0});
    }

    const Operator alice{"alice"};
    const Operator bob{"bob"};
    const Operator mallory{"mallory"};
    ale_verifier_t verifier{};
    ale_command_t command{};
};

TEST_F(Verify, AGenuineCommandIsHandedOverAsItWasGiven)
{
    ASSERT_EQ(verdict(signed_by(alice, drive(1))), ALE_GENUINE);
    EXPECT_STREQ(command.operator_name, "alice");
    EXPECT_STREQ(command.verb, "drive");
    ASSERT_EQ(command.args, 2U);
    EXPECT_STREQ(command.arg[0], "0.25");
    EXPECT_STREQ(command.arg[1], "-0.1");
    EXPECT_EQ(command.counter, 1);
}

TEST_F(Verify, ACounterThatDoesNotGrowIsAReplay)
{
    EXPECT_EQ(verdict(signed_by(alice, drive(5))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(alice, drive(5))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, drive(4))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, drive(0))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, drive(-1))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, drive(6))), ALE_GENUINE);
}

TEST_F(Verify, EachKeyHasACounterOfItsOwn)
{
    EXPECT_EQ(verdict(signed_by(alice, drive(1000))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(bob, drive(1))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(bob, drive(1))), ALE_REFUSED_REPLAYED);
}

TEST_F(Verify, ARefusedCommandDoesNotMoveTheCounter)
{
    ale_command_t late = drive(INT64_MAX);
    late.expiry_utime = now_utime - 1;
    EXPECT_EQ(verdict(signed_by(alice, late)), ALE_REFUSED_LATE);
    EXPECT_EQ(verdict(signed_by(alice, drive(1))), ALE_GENUINE);
}

/* Whoever made an operator sign it, and whatever else is wrong with it: it must not lock him out. */
TEST_F(Verify, ACounterFarAheadOfTheClockIsRefused)
{
    EXPECT_EQ(verdict(signed_by(alice, drive(now_utime + ALE_COMMAND_LIFE_US + 1))), ALE_REFUSED_LASTING);
    EXPECT_EQ(verdict(signed_by(alice, drive(INT64_MAX))), ALE_REFUSED_LASTING);
    EXPECT_EQ(verdict(signed_by(alice, drive(now_utime))), ALE_GENUINE);
}

TEST_F(Verify, AStopThatWasOvertakenStillStopsButOnlyOnce)
{
    const auto stop = [](int64_t counter) {
        ale_command_t made = drive(counter);
        std::strcpy(made.verb, "stop");
        made.args = 0;
        return made;
    };
    EXPECT_EQ(verdict(signed_by(alice, drive(9))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(alice, stop(8))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(alice, stop(8))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, stop(7))), ALE_REFUSED_REPLAYED);
    EXPECT_EQ(verdict(signed_by(alice, drive(9))), ALE_REFUSED_REPLAYED) << "it opens no way for others";
    EXPECT_EQ(verdict(signed_by(alice, stop(10))), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(alice, drive(10))), ALE_REFUSED_REPLAYED);
}

TEST_F(Verify, ACommandOfAnEarlierStartIsAReplay)
{
    const std::vector<uint8_t> old = signed_by(alice, drive(7));
    EXPECT_EQ(verdict(old), ALE_GENUINE);
    const ale_keys_t keys = verifier.keys;
    ale_verifier_init(&verifier, &keys, "rover", boot + 1);
    EXPECT_EQ(verdict(old), ALE_REFUSED_REPLAYED);
}

TEST_F(Verify, ItsTimeIsThatOfTheRobotsClock)
{
    EXPECT_EQ(verdict(signed_by(alice, drive(1)), now_utime + 1000000), ALE_GENUINE);
    EXPECT_EQ(verdict(signed_by(alice, drive(2)), now_utime + 1000001), ALE_REFUSED_LATE);
    ale_command_t lasting = drive(3);
    lasting.expiry_utime = now_utime + ALE_COMMAND_LIFE_US + 1;
    EXPECT_EQ(verdict(signed_by(alice, lasting)), ALE_REFUSED_LASTING);
    lasting.expiry_utime = INT64_MAX;
    EXPECT_EQ(verdict(signed_by(alice, lasting)), ALE_REFUSED_LASTING);
    lasting.expiry_utime = INT64_MIN;
    EXPECT_EQ(verdict(signed_by(alice, lasting)), ALE_REFUSED_LATE);
}

TEST_F(Verify, OtherRobotsAndStrangersAreRefused)
{
    ale_command_t other = drive(1);
    std::strcpy(other.robot, "rove");
    EXPECT_EQ(verdict(signed_by(alice, other)), ALE_REFUSED_ADDRESS);
    EXPECT_EQ(verdict(signed_by(mallory, drive(1))), ALE_REFUSED_STRANGER);
    Operator false_alice("alice");
    EXPECT_EQ(verdict(signed_by(false_alice, drive(1))), ALE_REFUSED_FORGED);
}

TEST_F(Verify, WithoutKeysNobodyIsObeyed)
{
    const ale_keys_t none{};
    ale_verifier_init(&verifier, &none, "rover", boot);
    EXPECT_EQ(verdict(signed_by(alice, drive(1))), ALE_REFUSED_STRANGER);
}

TEST_F(Verify, ACommandWithoutASignatureIsRefused)
{
    ale_command_t unsigned_command = drive(1);
    std::strcpy(unsigned_command.operator_name, "alice");
    uint8_t bytes[ALE_COMMAND_BYTES];
    const size_t count = ale_command_encode(&unsigned_command, nullptr, bytes);
    EXPECT_EQ(verdict({bytes, bytes + count}), ALE_REFUSED_UNSIGNED);
}

TEST_F(Verify, ItIsTheMessageThatLcmKnows)
{
    const std::vector<uint8_t> bytes = signed_by(alice, drive(3));
    ale::command_t message;
    ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
              static_cast<int>(bytes.size()));
    EXPECT_EQ(message.operator_name, "alice");
    EXPECT_EQ(message.args[1], "-0.1");
    EXPECT_EQ(message.num_signature, ALE_SIGNATURE_BYTES);
    EXPECT_EQ(message.counter, 3);
}

TEST_F(Verify, TextsThatWouldDisturbATerminalAreMalformed)
{
    for (const char bad : {'\n', '\x1b', '\x7f', '\xc3'}) {
        ale_command_t command_with = drive(1);
        command_with.arg[0][1] = bad;
        EXPECT_EQ(verdict(signed_by(alice, command_with)), ALE_REFUSED_MALFORMED);
    }
}

TEST_F(Verify, EveryCutAndEveryChangedBitIsRefused)
{
    const std::vector<uint8_t> honest = signed_by(alice, drive(9));
    for (size_t length = 0; length < honest.size(); length++) {
        EXPECT_EQ(verdict({honest.begin(), honest.begin() + static_cast<long>(length)}),
                  ALE_REFUSED_MALFORMED);
    }
    for (size_t bit = 0; bit < 8 * honest.size(); bit++) {
        std::vector<uint8_t> spoilt = honest;
        spoilt[bit / 8] ^= static_cast<uint8_t>(1U << bit % 8);
        const ale_verdict_t refused = verdict(spoilt);
        EXPECT_TRUE(refused == ALE_REFUSED_FORGED || refused == ALE_REFUSED_MALFORMED ||
                    refused == ALE_REFUSED_STRANGER)
            << "bit " << bit << ": " << ale_verdict_name(refused);
    }
    std::vector<uint8_t> longer = honest;
    longer.push_back(0);
    EXPECT_EQ(verdict(longer), ALE_REFUSED_MALFORMED);
    EXPECT_EQ(verdict(honest), ALE_GENUINE);
}

TEST_F(Verify, OfTenThousandHostileCommandsNoneIsObeyedAndAllAreCounted)
{
    std::mt19937 random(20);
    std::vector<std::vector<uint8_t>> heard;
    for (int64_t counter = 1; counter <= 100; counter++) {
        heard.push_back(signed_by(counter % 2 ? alice : bob, drive(counter)));
        ASSERT_EQ(verdict(heard.back()), ALE_GENUINE);
    }
    const auto pick = [&](size_t count) { return static_cast<size_t>(random()) % count; };
    for (int k = 0; k < 10000; k++) {
        std::vector<uint8_t> bytes = heard[pick(heard.size())]; /* replayed and out of order */
        switch (k % 5) {
        case 1: /* truncated */
            bytes.resize(pick(bytes.size()));
            break;
        case 2: /* changed */
            bytes[pick(bytes.size())] ^= static_cast<uint8_t>(1 + pick(255));
            break;
        case 3: /* the signature of one command under another */
            bytes = signed_by(alice, drive(1000 + k));
            std::copy(heard[0].end() - ALE_SIGNATURE_BYTES, heard[0].end(),
                      bytes.end() - ALE_SIGNATURE_BYTES);
            break;
        case 4: /* signed by somebody else in the name of a known operator */
            bytes = signed_by(k % 2 ? mallory : Operator("alice"), drive(1000 + k));
            break;
        default:
            break;
        }
        ASSERT_NE(verdict(bytes), ALE_GENUINE) << k;
    }
    EXPECT_EQ(verifier.count[ALE_GENUINE], 100U);
    EXPECT_EQ(counted(), 10100U);
    EXPECT_GE(verifier.count[ALE_REFUSED_REPLAYED], 2000U);
    EXPECT_GE(verifier.count[ALE_REFUSED_MALFORMED], 2000U);
    EXPECT_GE(verifier.count[ALE_REFUSED_FORGED], 4000U);
}

} // namespace
