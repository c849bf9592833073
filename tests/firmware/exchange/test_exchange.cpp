#include <gtest/gtest.h>

extern "C" {
#include "exchange/exchange.h"
}

namespace
{

constexpr int64_t kLong = 1000000000;

class Exchange : public testing::Test
{
  protected:
    void SetUp() override
    {
        ASSERT_EQ(ale_exchange_open(&exchange, ale_clock_start(ALE_CLOCK_REAL)), 0);
    }
    void TearDown() override
    {
        ale_exchange_close(&exchange);
        EXPECT_EQ(exchange.under_way, -1);
    }
    static void add(ale_ring_t *ring)
    {
        if (ale_ring_reserve(ring)) {
            ale_ring_commit(ring);
        }
    }
    ale_exchange_t exchange{};
};

TEST_F(Exchange, WithNoScanOnItsWayTelemetryMaySleep)
{
    EXPECT_EQ(ale_exchange_result_wait_ns(&exchange, kLong), kLong);
}

TEST_F(Exchange, WhileAScanIsOnItsWayTelemetryLooksOften)
{
    add(exchange.scans);
    EXPECT_LE(ale_exchange_result_wait_ns(&exchange, kLong), 1000000);
    EXPECT_EQ(ale_exchange_result_wait_ns(&exchange, 100), 100);
}

/* The result may come between the last look into the ring and the decision how long to sleep. */
TEST_F(Exchange, AResultThatIsReadyIsNeverSleptOver)
{
    add(exchange.scans);
    add(exchange.results);
    EXPECT_EQ(ale_exchange_result_wait_ns(&exchange, kLong), 0);
    ale_ring_release(exchange.results);
    EXPECT_EQ(ale_exchange_result_wait_ns(&exchange, kLong), kLong);
}

TEST_F(Exchange, AResultThatFoundNoRoomIsNotWaitedFor)
{
    for (int k = 0; k <= ALE_RESULT_SLOTS; k++) {
        add(exchange.scans);
        ale_ring_release(exchange.scans);
        add(exchange.results);
    }
    for (int k = 0; k < ALE_RESULT_SLOTS; k++) {
        ale_ring_release(exchange.results);
    }
    EXPECT_EQ(ale_exchange_result_wait_ns(&exchange, kLong), kLong);
}

TEST_F(Exchange, ClosingTwiceIsHarmless)
{
    ale_exchange_close(&exchange);
}

} // namespace
