/* What the firmware's threads find around them: the real-time port as an ordinary program has it, and the
 * exchange. */
#ifndef TESTS_FIRMWARE_SURROUNDINGS_HPP
#define TESTS_FIRMWARE_SURROUNDINGS_HPP

#include <gtest/gtest.h>

extern "C" {
#include "exchange/exchange.h"
}

namespace surroundings
{

class WithPort : public testing::Test
{
  protected:
    WithPort()
    {
        const ale_rt_config_t nothing_asked_for = {0, -1, false};
        EXPECT_EQ(ale_rt_start(&nothing_asked_for, &port_report), 0);
    }
    ~WithPort() override
    {
        ale_rt_stop();
    }
    ale_rt_report_t port_report{};
};

class WithExchange : public WithPort
{
  protected:
    explicit WithExchange(int32_t scale_ppm = ALE_CLOCK_REAL)
    {
        EXPECT_EQ(ale_exchange_open(&exchange, ale_clock_start(scale_ppm)), 0);
    }
    ~WithExchange() override
    {
        ale_exchange_close(&exchange);
    }
    ale_exchange_t exchange{};
};

} // namespace surroundings

#endif
