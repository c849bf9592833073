#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

extern "C" {
#include "lcm/sender_clocks.h"
}

namespace
{

constexpr int64_t kSecond = 1000000;
constexpr int64_t kHour = 3600 * kSecond;

/* A sender 20 times a second, whose messages take 2 ms and what happens to them; its clock is ahead of the
 * robot's by `ahead` and gains `ppm`. */
class Sender
{
  public:
    explicit Sender(int64_t ahead_us = 0, double ppm = 0, int32_t scale_ppm = 1000000)
        : ahead(ahead_us), rate(ppm * 1e-6)
    {
        ale_sender_clock_init(&clock, scale_ppm);
    }
    /* Sends for some seconds; the worst error of a time that was told, and how many were refused. */
    void send(double seconds)
    {
        worst_us = 0;
        refused = 0;
        const int64_t end = now + static_cast<int64_t>(seconds * kSecond);
        for (; now < end; now += period) {
            sent++;
            const auto gained = static_cast<int64_t>(static_cast<double>(now) * rate);
            const auto held_up = static_cast<int64_t>(delay(random) * 1000);
            int64_t time = 0;
            if (!ale_sender_clock_take(&clock, now + ahead + gained, now + 2000 + held_up, &time)) {
                refused++;
            } else {
                worst_us = std::max<int64_t>(worst_us, std::llabs(time - now));
            }
        }
    }
    ale_sender_clock_t clock{};
    int64_t now = 100 * kHour;
    int64_t ahead;
    double rate;
    int64_t period = kSecond / 20;
    int64_t worst_us = 0;
    int refused = 0;
    int sent = 0;
    std::mt19937 random{7};
    std::exponential_distribution<double> delay{0.2}; /* 5 ms in the mean */
};

TEST(SenderClock, StampsOfTheRobotsOwnClockCountAsTheyAre)
{
    Sender sender;
    sender.send(3600);
    EXPECT_EQ(sender.worst_us, 0);
    EXPECT_EQ(sender.refused, 0);
    EXPECT_EQ(sender.clock.steps, 0U);
}

TEST(SenderClock, AnyOtherClockIsTheOneOfItsFastestMessage)
{
    for (const int64_t ahead :
         {-50 * 365 * 24 * kHour, -kHour, -kSecond / 2, kSecond / 2, kHour, 50 * 365 * 24 * kHour}) {
        Sender sender(ahead);
        sender.send(10);
        sender.send(3600);
        EXPECT_LE(sender.worst_us, 5000) << ahead;
        EXPECT_EQ(sender.refused, 0) << ahead;
    }
}

TEST(SenderClock, AnHourAheadOrBackIsFollowedWithinAFifthOfASecond)
{
    for (const int64_t step : {-kHour, kHour, -kSecond, kSecond}) {
        for (const int64_t before : {int64_t{0}, -20 * kHour}) {
            Sender sender(before);
            sender.send(60);
            sender.ahead += step;
            sender.send(10);
            EXPECT_LE(sender.refused, 5) << step;
            EXPECT_EQ(sender.clock.steps, 1U) << step;
            EXPECT_NEAR(static_cast<double>(sender.clock.step_us), static_cast<double>(step), 50e3);
            EXPECT_LE(sender.worst_us, 25000) << step << ": a delay of three messages";
            sender.send(60);
            EXPECT_EQ(sender.refused, 0);
            EXPECT_LE(sender.worst_us, 5000) << step;
        }
    }
}

TEST(SenderClock, AClockThatIsSetRightIsTheRobotsAgain)
{
    Sender sender(-50 * 365 * 24 * kHour);
    sender.send(60);
    sender.ahead = 0;
    sender.send(1);
    sender.send(60);
    EXPECT_EQ(sender.worst_us, 0);
}

TEST(SenderClock, ADriftOf100PpmIsFollowedForHours)
{
    for (const double ppm : {-100.0, 100.0}) {
        for (const int64_t ahead : {int64_t{0}, 7 * kHour}) {
            Sender sender(ahead, ppm);
            sender.now = 0; /* the clocks agree now, or are seven hours apart */
            sender.send(10);
            sender.send(12 * 3600);
            EXPECT_EQ(sender.refused, 0) << ppm;
            EXPECT_EQ(sender.clock.steps, 0U) << ppm;
            EXPECT_LE(sender.worst_us, 15000) << ppm << ", " << ahead;
        }
    }
}

TEST(SenderClock, ASmallStepIsFollowedWithoutARefusal)
{
    for (const int64_t step : {-kSecond / 5, kSecond / 5}) {
        Sender sender;
        sender.send(60);
        sender.ahead += step;
        sender.send(10);
        EXPECT_EQ(sender.refused, 0) << step;
        sender.send(60);
        EXPECT_LE(sender.worst_us, 15000) << step;
    }
}

TEST(SenderClock, AMessageThatWasHeldUpMovesNothing)
{
    Sender sender;
    sender.send(60);
    int64_t time = 0;
    for (int k = 1; k <= 20; k++) { /* a second of them comes at once, the first a second late */
        ASSERT_TRUE(ale_sender_clock_take(&sender.clock, sender.now + k * sender.period,
                                          sender.now + 20 * sender.period + k, &time));
        EXPECT_EQ(time, sender.now + k * sender.period);
    }
    sender.now += 21 * sender.period;
    sender.send(60);
    EXPECT_EQ(sender.worst_us, 0);
    EXPECT_EQ(sender.clock.steps, 0U);
}

TEST(SenderClock, OneStampOfNonsenseIsRefusedAlone)
{
    Sender sender;
    sender.send(60);
    int64_t time = 5;
    for (const int64_t stamp : {int64_t{0}, int64_t{1}, sender.now + kHour, sender.now - kHour}) {
        EXPECT_FALSE(ale_sender_clock_take(&sender.clock, stamp, sender.now + 2000, &time));
        EXPECT_EQ(time, 5) << "untouched";
        sender.send(1);
        EXPECT_EQ(sender.refused, 0);
        EXPECT_EQ(sender.worst_us, 0);
    }
}

TEST(SenderClock, AStampThatStandsStillIsRefusedFromHalfASecondOn)
{
    Sender sender;
    sender.send(60);
    const int64_t stuck = sender.now;
    int64_t time = 0;
    int taken = 0;
    for (int k = 1; k <= 200; k++) {
        taken += ale_sender_clock_take(&sender.clock, stuck, stuck + k * sender.period, &time);
    }
    EXPECT_LE(taken, 10);
    EXPECT_EQ(sender.clock.steps, 0U);
}

TEST(SenderClock, InASimulationThatRunsFasterAHostThatIsBusyStepsNoClock)
{
    Sender sender(0, 0, 20000000);
    sender.delay = std::exponential_distribution<double>(0.01); /* 100 ms in the mean: 5 ms of the host's */
    sender.send(3600);
    EXPECT_EQ(sender.refused, 0);
    EXPECT_EQ(sender.worst_us, 0);
}

TEST(SenderClocks, EachSenderHasItsOwn)
{
    ale_sender_clocks_t clocks{};
    clocks.scale_ppm = 1000000;
    int64_t time = 0;
    for (int64_t now = kHour; now < kHour + 10 * kSecond; now += kSecond / 10) {
        ASSERT_TRUE(ale_sender_clocks_take(&clocks, 11, now, now + 1000, &time));
        EXPECT_EQ(time, now);
        ASSERT_TRUE(ale_sender_clocks_take(&clocks, 12, now + 5 * kHour, now + 1000, &time));
        EXPECT_EQ(time, now + 1000);
    }
    EXPECT_EQ(ale_sender_clocks_heard_since(&clocks, kHour), 2U);
    EXPECT_EQ(ale_sender_clocks_heard_since(&clocks, 2 * kHour), 0U);
    EXPECT_EQ(clocks.steps, 0U);
    EXPECT_EQ(clocks.refused, 0U);
}

TEST(SenderClocks, OneTooManyTakesThePlaceOfTheOldest)
{
    ale_sender_clocks_t clocks{};
    clocks.scale_ppm = 1000000;
    int64_t time = 0;
    for (uint64_t sender = 1; sender <= 100; sender++) {
        const auto now = static_cast<int64_t>(sender) * kSecond;
        ASSERT_TRUE(ale_sender_clocks_take(&clocks, 1000, now, now, &time));
        ASSERT_TRUE(ale_sender_clocks_take(&clocks, sender, now - kHour, now + 1, &time));
        EXPECT_EQ(time, now + 1);
    }
    EXPECT_EQ(ale_sender_clocks_heard_since(&clocks, 0), static_cast<uint32_t>(ALE_MOST_SENDERS));
    EXPECT_EQ(clocks.steps, 0U);
}

} // namespace
