#include <gtest/gtest.h>

#include <map>
#include <string>

#include "firmware/surroundings.hpp"

extern "C" {
#include "telemetry/odometry_intake.h"
}

namespace
{

constexpr int64_t kHour = 3600LL * 1000000;

class OdometryIntake : public surroundings::WithExchange
{
  protected:
    OdometryIntake()
    {
        ale_odometry_intake_init(&intake, &exchange);
    }
    /* Taken at this moment, by a clock that is so much ahead of the robot's. */
    void take(int64_t ahead_us, uint64_t sender = 1)
    {
        const int64_t now_us = ale_clock_now_us(&exchange.clock);
        const ale_odometry_t sample = {ale_clock_to_utime(&exchange.clock, now_us) + ahead_us, {x++, 0, 0}};
        ale_odometry_intake_take(&intake, &sample, sender);
    }
    std::map<std::string, uint64_t> counters(ale_bus_refused_t refused = {})
    {
        ale_status_report_t report{};
        ale_odometry_intake_counters(&intake, refused, &report);
        std::map<std::string, uint64_t> values;
        for (uint32_t k = 0; k < report.counters; k++) {
            values[report.counter[k].name] = report.counter[k].value;
        }
        return values;
    }
    ale_odometry_intake_t intake{};
    int32_t x = 0;
};

TEST_F(OdometryIntake, SamplesReachTheRingInTheRobotsTimeByWhicheverClock)
{
    uint64_t sender = 1;
    for (const int64_t ahead : {int64_t{0}, kHour, -kHour}) {
        const int64_t before_us = ale_clock_now_us(&exchange.clock);
        take(ahead, sender++);
        ASSERT_EQ(ale_ring_ready(exchange.odometry), 1U);
        const auto *sample = static_cast<const ale_odometry_t *>(ale_ring_at(exchange.odometry, 0));
        EXPECT_GE(sample->stamp_us, before_us);
        EXPECT_LE(sample->stamp_us, ale_clock_now_us(&exchange.clock));
        ale_ring_release(exchange.odometry);
    }
    EXPECT_EQ(counters()["odometry_senders"], 3U);
}

TEST_F(OdometryIntake, WhatIsRefusedIsCountedByReasonAndInAll)
{
    take(0);
    take(kHour);
    take(-kHour);
    EXPECT_EQ(ale_ring_ready(exchange.odometry), 1U);
    auto values = counters({3, 4});
    EXPECT_EQ(values["odometry_malformed"], 3U);
    EXPECT_EQ(values["odometry_unstamped"], 4U);
    EXPECT_EQ(values["odometry_misdated"], 2U);
    EXPECT_EQ(values["odometry_refused"], 9U);
    EXPECT_EQ(values["odometry_clock_steps"], 0U);
}

TEST_F(OdometryIntake, AStepIsSaidOnceInWords)
{
    char line[ALE_INTAKE_LINE] = "";
    EXPECT_FALSE(ale_odometry_intake_word(&intake, line));
    intake.clocks.steps = 1;
    intake.clocks.step_us = -kHour;
    ASSERT_TRUE(ale_odometry_intake_word(&intake, line));
    EXPECT_STREQ(line, "odometry: the clock of its sender was set by -3600.0 s: followed");
    EXPECT_FALSE(ale_odometry_intake_word(&intake, line));
    intake.clocks.steps = 2;
    EXPECT_FALSE(ale_odometry_intake_word(&intake, line)) << "ten seconds have to pass";
}

} // namespace
