/* Both ends of the link as bytes, and somebody between them who records, changes and plays again. */
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "operator/bridge/ends.h"

using bridge::Address;
using bridge::Ends;
using bridge::Frame;
using bridge::Session;

namespace
{

using Bytes = std::vector<uint8_t>;

struct Person {
    ale_secret_key_t secret{};
    ale_public_key_t known{};
    explicit Person(const char *name)
    {
        ale_keys_make(name, &secret, &known);
    }
};

ale_keys_t list(const std::vector<Person> &persons)
{
    ale_keys_t keys{};
    for (const Person &one : persons) {
        keys.operator_key[keys.count++] = one.known;
    }
    return keys;
}

Frame message(const char *channel)
{
    static const uint8_t payload[] = {1, 2, 3};
    Frame frame;
    frame.channel = channel;
    frame.message = payload;
    frame.size = sizeof payload;
    return frame;
}

class Link : public testing::Test
{
  protected:
    /* Bytes that came in at the robot's end: whether they were those of an end that has proved who it is. */
    static bool take(Ends &end, const Bytes &bytes, const Address &from)
    {
        Session *session = end.of(bytes);
        const bool opened = session && session->open(bytes, from, now);
        if (opened) {
            end.confirm(*session);
        }
        return opened;
    }
    static bool take(Ends &end, const Bytes &bytes)
    {
        return take(end, bytes, Address::of("127.0.0.1:7700"));
    }
    bool meet(Ends &operators)
    {
        const Bytes answer = robot.greet(operators.hello(), somewhere, now);
        return operators.greeted(answer, somewhere, now) && take(robot, seal(operators));
    }
    static Bytes seal(Ends &end, const char *channel = "ALE_COMMAND")
    {
        return end.sessions().back().seal(message(channel));
    }

    static constexpr int64_t now = 5000000;
    const Address somewhere = Address::of("127.0.0.1:7700");
    const Person rover{"rover"};
    const Person alice{"alice"};
    const Person bob{"bob"};
    const Person mallory{"alice"};
    Ends robot = Ends::of_robot(rover.secret, list({alice, bob}));
    Ends laptop = Ends::of_operator(alice.secret, list({rover}), somewhere);
};

TEST_F(Link, EndsThatKnowEachOtherCarryBothWays)
{
    ASSERT_TRUE(meet(laptop));
    ASSERT_EQ(robot.sessions().size(), 1U);
    EXPECT_EQ(robot.sessions().front().name(), "alice");
    EXPECT_TRUE(take(robot, seal(laptop)));
    EXPECT_TRUE(take(laptop, seal(robot, "ALE_POSE")));
}

TEST_F(Link, SeveralOperatorsHaveSessionsOfTheirOwn)
{
    Ends other = Ends::of_operator(bob.secret, list({rover}), somewhere);
    ASSERT_TRUE(meet(laptop));
    ASSERT_TRUE(meet(other));
    EXPECT_EQ(robot.sessions().size(), 2U);
    EXPECT_TRUE(take(robot, seal(laptop)));
    EXPECT_TRUE(take(robot, seal(other)));
    EXPECT_FALSE(take(other, robot.sessions().front().seal(message("ALE_POSE")))) << "alice's";
}

TEST_F(Link, StrangersAreNotGreetedAndNotBelieved)
{
    Ends stranger = Ends::of_operator(mallory.secret, list({rover}), somewhere);
    EXPECT_TRUE(robot.greet(stranger.hello(), somewhere, now).empty());
    const Person false_rover("rover");
    Ends trap = Ends::of_robot(false_rover.secret, list({alice}));
    EXPECT_FALSE(laptop.greeted(trap.greet(laptop.hello(), somewhere, now), somewhere, now));
    EXPECT_TRUE(laptop.sessions().empty());
}

TEST_F(Link, NoAnswerIsLargerThanItsQuestion)
{
    const Bytes hello = laptop.hello();
    EXPECT_LE(robot.greet(hello, somewhere, now).size(), hello.size());
    for (size_t count = 0; count < hello.size(); count++) {
        EXPECT_TRUE(
            robot.greet({hello.begin(), hello.begin() + static_cast<long>(count)}, somewhere, now).empty());
    }
}

TEST_F(Link, AHelloThatIsPlayedAgainBringsNobodyInAndNobodyOut)
{
    const Bytes hello = laptop.hello();
    ASSERT_TRUE(meet(laptop));
    for (int k = 0; k < 100; k++) {
        robot.greet(hello, Address::of("127.0.0.1:9"), now + 2000000 * k);
    }
    ASSERT_EQ(robot.sessions().size(), 1U) << "who has not the key is sent nothing";
    EXPECT_TRUE(take(robot, seal(laptop)));
    EXPECT_TRUE(take(laptop, seal(robot, "ALE_POSE")));
}

TEST_F(Link, EveryDatagramIsTakenOnceInAnyOrder)
{
    ASSERT_TRUE(meet(laptop));
    std::vector<Bytes> sent;
    for (int k = 0; k < 200; k++) {
        sent.push_back(seal(laptop));
    }
    std::shuffle(sent.begin(), sent.end(), std::mt19937(1));
    for (const Bytes &bytes : sent) {
        EXPECT_TRUE(take(robot, bytes));
        EXPECT_FALSE(take(robot, bytes));
    }
    for (int k = 0; k < 2000; k++) {
        EXPECT_TRUE(take(robot, seal(laptop)));
    }
    for (const Bytes &bytes : sent) {
        EXPECT_FALSE(take(robot, bytes)) << "beyond what is remembered";
    }
}

TEST_F(Link, NoBitMayBeAnotherAndNobodyMovesTheSequence)
{
    ASSERT_TRUE(meet(laptop));
    const Bytes good = seal(laptop);
    for (size_t bit = 0; bit < 8 * good.size(); bit++) {
        Bytes bad = good;
        bad[bit / 8] ^= static_cast<uint8_t>(1U << bit % 8);
        EXPECT_FALSE(take(robot, bad)) << bit;
    }
    Bytes ahead = good; /* sequence + 0x7ffffff0 */
    ahead[18] ^= 0x7f;
    EXPECT_FALSE(take(robot, ahead));
    EXPECT_TRUE(take(robot, good));
}

TEST_F(Link, WhoMovesIsFollowedWhoPlaysAgainIsNot)
{
    ASSERT_TRUE(meet(laptop));
    const Bytes old = seal(laptop);
    const Address moved = Address::of("127.0.0.1:7701");
    EXPECT_TRUE(take(robot, seal(laptop), moved));
    EXPECT_EQ(robot.sessions().front().address().name(), "127.0.0.1:7701");
    EXPECT_TRUE(take(robot, old, somewhere)) << "late, from where he was";
    EXPECT_EQ(robot.sessions().front().address().name(), "127.0.0.1:7701");
}

TEST_F(Link, HellosWithoutEndCostOnlySoMuch)
{
    int answered = 0;
    for (int k = 0; k < 1000; k++) {
        Ends one = Ends::of_operator(alice.secret, list({rover}), somewhere);
        answered += !robot.greet(one.hello(), somewhere, now).empty();
    }
    EXPECT_EQ(answered, 50);
    Ends later = Ends::of_operator(bob.secret, list({rover}), somewhere);
    EXPECT_FALSE(robot.greet(later.hello(), somewhere, now + 1000000).empty());
}

TEST_F(Link, SilentEndsAreForgottenAndGreetAgain)
{
    ASSERT_TRUE(meet(laptop));
    robot.forget_silent(now + 3000001);
    laptop.forget_silent(now + 3000001);
    EXPECT_TRUE(robot.sessions().empty());
    EXPECT_TRUE(meet(laptop));
}

} // namespace
