/* What the motors are told, as a pure choice and as the thread publishes it. */
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ale/drive_t.hpp"
#include "drivers/lcm/own_port.hpp"
#include "firmware/room.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "exchange/wake.h"
#include "lcm/bus.h"
#include "operator/drive.h"
#include "operator/drive_arbiter.h"
}

/* As in test_telemetry.cpp: GLib orders LCM's mutex by means that the sanitizer does not see. */
extern "C" const char *__tsan_default_suppressions()
{
    return "race:g_static_rec_mutex_lock";
}

namespace
{

constexpr int64_t kNow = 5000000;

class DriveChoice : public testing::Test
{
  protected:
    void SetUp() override
    {
        config = ale_config_default();
        room::fill(*scan, 0, 0, kNow - 100000);
    }
    ale_set_point_t choose(int64_t now = kNow)
    {
        return ale_drive_choose(&orders, &exploration, scan.get(), &config, now);
    }
    ale_config_t config{};
    std::unique_ptr<ale_scan_t> scan = std::make_unique<ale_scan_t>();
    ale_drive_orders_t orders{};
    ale_velocity_request_t exploration{};
};

TEST_F(DriveChoice, WithoutARequestItStandsStill)
{
    EXPECT_EQ(choose().v_um_s, 0);
    EXPECT_EQ(choose().w_urad_s, 0);
}

TEST_F(DriveChoice, ARequestHoldsUntilItsMomentAndNoLonger)
{
    orders.operator_request = {200000, 100000, kNow};
    EXPECT_EQ(choose(kNow - 1).v_um_s, 200000);
    EXPECT_EQ(choose(kNow - 1).w_urad_s, 100000);
    EXPECT_EQ(choose(kNow).v_um_s, 0);
    EXPECT_EQ(choose(kNow).w_urad_s, 0);
}

/* The thread's turns on a clock of the test's own: whatever the phase of the turns, the first set point at
 * zero is that of the moment at which the command's 300 ms are over. */
TEST_F(DriveChoice, TheRobotStandsExactlyWhenTheDeadMansTimeIsOver)
{
    for (int64_t phase_us = 0; phase_us < ALE_DRIVE_PERIOD_US; phase_us += 777) {
        ale_drive_arbiter_t arbiter{};
        ASSERT_EQ(ale_drive_arbiter_drive(&arbiter, "alice", 200000, 300000, kNow), ALE_ARBITER_GRANTED);
        orders.operator_request = arbiter.request;
        int64_t now = kNow + phase_us;
        int64_t longest_us = 0;
        while (choose(now).v_um_s > 0) {
            const int64_t wait_us = ale_drive_wait_us(&orders, &exploration, now);
            ASSERT_GT(wait_us, 0);
            longest_us = std::max(longest_us, wait_us);
            now += wait_us;
        }
        EXPECT_EQ(now, kNow + 300000);
        EXPECT_EQ(longest_us, ALE_DRIVE_PERIOD_US);
    }
}

TEST_F(DriveChoice, SetPointsComeEveryPeriodAlsoWhenNobodyWantsAnything)
{
    EXPECT_EQ(ale_drive_wait_us(&orders, &exploration, kNow), ALE_DRIVE_PERIOD_US);
    EXPECT_LE(ALE_DRIVE_PERIOD_US, 50000) << "20 times a second at least";
    exploration.valid_until_us = kNow + 1;
    EXPECT_EQ(ale_drive_wait_us(&orders, &exploration, kNow), 1);
    EXPECT_EQ(ale_drive_wait_us(&orders, &exploration, kNow + 1), ALE_DRIVE_PERIOD_US);
}

TEST_F(DriveChoice, TheOperatorGoesBeforeExplorationAndAStopBeforeBoth)
{
    exploration = {100000, 0, kNow + 1};
    EXPECT_EQ(choose().v_um_s, 0) << "nobody has asked for exploration";
    orders.exploring = true;
    EXPECT_EQ(choose().v_um_s, 100000);
    orders.operator_request = {200000, 0, kNow + 1};
    EXPECT_EQ(choose().v_um_s, 200000);
    orders = {};
    EXPECT_EQ(choose().v_um_s, 0);
}

TEST_F(DriveChoice, TowardsAWallItIsSlowedOnTheSameArcAndThenTurnsOnly)
{
    orders.operator_request = {3000000, 1500000, kNow + 1};
    const ale_set_point_t slow = choose();
    EXPECT_GT(slow.v_um_s, 0);
    EXPECT_LT(slow.v_um_s, 2000000);
    EXPECT_NEAR(slow.w_urad_s, slow.v_um_s / 2, 1);
    room::fill(*scan, room::kHalfLength - 0.22, 0, kNow - 100000);
    orders.operator_request = {300000, 150000, kNow + 1};
    EXPECT_EQ(choose().v_um_s, 0);
    EXPECT_EQ(choose().w_urad_s, 150000);
}

TEST_F(DriveChoice, WithoutAFreshScanNothingMoves)
{
    orders.operator_request = {200000, 100000, kNow + 10000000};
    EXPECT_GT(choose(scan->stamp_us + 500000).v_um_s, 0);
    EXPECT_EQ(choose(scan->stamp_us + 500001).v_um_s, 0);
    EXPECT_EQ(choose(scan->stamp_us + 500001).w_urad_s, 0);
    *scan = {};
    EXPECT_EQ(choose(100000).v_um_s, 0);
}

/* The thread, with snapshots that the test fills. Skipped without a multicast route. */
class DriveThread : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        config = ale_config_default();
        std::snprintf(config.lcm_url, sizeof config.lcm_url, "%s", own_lcm_url().c_str());
        char error[ALE_BUS_ERROR] = "";
        ale_bus_t *probe = ale_bus_open(config.lcm_url, error);
        if (!probe) {
            GTEST_SKIP() << error;
        }
        ale_bus_close(probe);
        lcm = lcm_create(config.lcm_url);
        lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "ALE_DRIVE", take, this), 0);
        drive = ale_drive_start(&config, nullptr, &exchange);
        ASSERT_NE(drive, nullptr);
    }
    void TearDown() override
    {
        ale_drive_stop(drive);
        if (lcm) {
            lcm_destroy(lcm);
        }
    }
    static void take(const lcm_recv_buf_t *buffer, const char *, void *user)
    {
        ale::drive_t message;
        ASSERT_GT(message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)), 0);
        static_cast<DriveThread *>(user)->heard.push_back(message);
    }
    void order(const ale_drive_orders_t &orders)
    {
        room::fill(*static_cast<ale_scan_t *>(ale_snapshot_back(exchange.drive_scan)), 0, 0,
                   ale_clock_now_us(&exchange.clock));
        ale_snapshot_publish(exchange.drive_scan);
        *static_cast<ale_drive_orders_t *>(ale_snapshot_back(exchange.drive_orders)) = orders;
        ale_snapshot_publish(exchange.drive_orders);
        ale_wake_post(exchange.drive_again);
    }
    void hear_until(const std::function<bool()> &condition)
    {
        for (int k = 0; !condition(); k++) {
            ASSERT_GT(lcm_handle_timeout(lcm, 180000), 0) << "nothing came for three minutes";
            ASSERT_LT(k, 1000) << "of all that came, nothing was it";
        }
    }
    /* The robot drives by a request of the dead man's time; one that was over before the thread's turn came
     * is given anew. The moment at which it ends. */
    int64_t drive_by_a_request()
    {
        int64_t given_us = -ALE_DEAD_MAN_US;
        hear_until([&] {
            const int64_t now_us = ale_clock_now_us(&exchange.clock);
            if (now_us >= given_us + ALE_DEAD_MAN_US) {
                given_us = now_us;
                order({{200000, 0, given_us + ALE_DEAD_MAN_US}, false});
            }
            return !heard.empty() && heard.back().v > 0 &&
                   heard.back().utime >= ale_clock_to_utime(&exchange.clock, given_us);
        });
        return given_us + ALE_DEAD_MAN_US;
    }

    ale_config_t config{};
    lcm_t *lcm = nullptr;
    ale_drive_t *drive = nullptr;
    std::vector<ale::drive_t> heard;
};

TEST_F(DriveThread, TellsTheMotorsAgainAndAgainAlsoToStandStill)
{
    hear_until([&] { return heard.size() >= 11; });
    for (const ale::drive_t &message : heard) {
        EXPECT_EQ(message.v, 0);
    }
    const int64_t span_us = heard[10].utime - heard[0].utime;
    EXPECT_GE(span_us, 10 * ALE_DRIVE_PERIOD_US * 9 / 10);
}

TEST_F(DriveThread, ARequestEndsOnTheMicrosecondClockWithoutAnybodysHelp)
{
    const int64_t until_us = drive_by_a_request();
    hear_until([&] { return heard.back().v == 0; });
    EXPECT_GE(heard.back().utime, ale_clock_to_utime(&exchange.clock, until_us));
    EXPECT_LT(heard[heard.size() - 2].utime, ale_clock_to_utime(&exchange.clock, until_us));
}

TEST_F(DriveThread, EndsWithStandingStill)
{
    drive_by_a_request();
    ale_drive_stop(drive);
    drive = nullptr;
    hear_until([&] { return heard.back().v == 0; });
}

} // namespace
