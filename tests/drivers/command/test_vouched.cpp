/* What a robot has signed, and what it has not. */
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "drivers/command/signed_command.hpp"

extern "C" {
#include "command/vouched.h"
}

using signed_command::Operator;

namespace
{

class Vouched : public testing::Test
{
  protected:
    void SetUp() override
    {
        robots = signed_command::keys_of({Operator("scout"), rover});
        for (size_t k = 0; k < bytes.size(); k++) {
            bytes[k] = static_cast<uint8_t>(k * 7);
        }
        std::memcpy(&bytes[16], rover.known.key, 8);
        ale_vouched_sign(&rover.secret, bytes.data(), bytes.size());
    }
    bool is_vouched(const std::vector<uint8_t> &message) const
    {
        return ale_is_vouched(&robots, message.data(), message.size());
    }
    const Operator rover{"rover"};
    ale_keys_t robots{};
    std::vector<uint8_t> bytes = std::vector<uint8_t>(300);
};

TEST_F(Vouched, ByARobotThatIsKnown)
{
    EXPECT_TRUE(is_vouched(bytes));
    EXPECT_NE(ale_vouched_key(&rover.known), 0);
}

TEST_F(Vouched, NotWithOneBitAnother)
{
    for (size_t bit = 0; bit < bytes.size() * 8; bit++) {
        std::vector<uint8_t> other = bytes;
        other[bit / 8] ^= static_cast<uint8_t>(1U << bit % 8);
        EXPECT_FALSE(is_vouched(other)) << bit;
    }
}

TEST_F(Vouched, NotWhenCutOrLonger)
{
    for (size_t count = 0; count < bytes.size(); count++) {
        EXPECT_FALSE(is_vouched({bytes.begin(), bytes.begin() + static_cast<long>(count)})) << count;
    }
    std::vector<uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(is_vouched(longer));
}

TEST_F(Vouched, ANameInTheListIsOfOneRobot)
{
    const int64_t key = ale_vouched_key(&rover.known);
    EXPECT_TRUE(ale_may_be_called(&robots, key, "rover"));
    EXPECT_TRUE(ale_may_be_called(&robots, key, "kitchen"));
    EXPECT_FALSE(ale_may_be_called(&robots, key, "scout"));
}

TEST_F(Vouched, NotByAnotherOrByNobody)
{
    const ale_keys_t nobody{};
    EXPECT_FALSE(ale_is_vouched(&nobody, bytes.data(), bytes.size()));
    const Operator mallory("rover");
    ale_vouched_sign(&mallory.secret, bytes.data(), bytes.size());
    EXPECT_FALSE(is_vouched(bytes)) << "in the name of the rover";
    std::memcpy(&bytes[16], mallory.known.key, 8);
    ale_vouched_sign(&mallory.secret, bytes.data(), bytes.size());
    EXPECT_FALSE(is_vouched(bytes));
}

} // namespace
