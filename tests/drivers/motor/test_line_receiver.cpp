/* Lines of set points: taken as they were made, and nothing else is. */
#include <gtest/gtest.h>

#include <random>
#include <string>

extern "C" {
#include "motor/line_receiver.h"
#include "motor/set_point.h"
}

namespace
{

std::string line_of(uint32_t counter, int32_t v_um_s, int32_t w_urad_s)
{
    char text[ALE_SET_POINT_LINE];
    const size_t length = ale_set_point_line(counter, v_um_s, w_urad_s, text);
    return {text, length};
}

class Line : public testing::Test
{
  protected:
    int feed(const std::string &text)
    {
        int taken = 0;
        for (const char byte : text) {
            taken += ale_motor_byte(&line, byte, now_ms);
        }
        return taken;
    }
    void expect(int32_t v, int32_t w)
    {
        int32_t v_mm_s = -1;
        int32_t w_mrad_s = -1;
        ale_motor_line_set_point(&line, now_ms, &v_mm_s, &w_mrad_s);
        EXPECT_EQ(v_mm_s, v);
        EXPECT_EQ(w_mrad_s, w);
    }
    ale_motor_line_t line{};
    uint32_t now_ms = 1000;
};

TEST_F(Line, LooksAsItIsDocumented)
{
    EXPECT_EQ(ale_motor_crc("123456789", 9), 0x29B1) << "the check value of CRC-16/CCITT-FALSE";
    EXPECT_EQ(line_of(17, 250000, -100000).substr(0, 17), "$ALE,17,250,-100*");
}

TEST_F(Line, AreTakenAndEndAfter300Ms)
{
    EXPECT_EQ(feed(line_of(1, 250000, -100000)), 1);
    expect(250, -100);
    now_ms += 299;
    expect(250, -100);
    now_ms += 1;
    expect(0, 0);
    EXPECT_EQ(feed(line_of(4000000000U, INT32_MIN, INT32_MAX)), 1);
    expect(INT32_MIN / 1000, INT32_MAX / 1000);
}

TEST_F(Line, WhatIsSaidTwiceCountsOnce)
{
    EXPECT_EQ(feed(line_of(5, 1000, 0) + line_of(5, 1000, 0)), 1);
    EXPECT_EQ(feed(line_of(1, 2000, 0)), 1) << "the robot started again";
}

TEST_F(Line, DamageIsRefusedAndTheNextLineTaken)
{
    const std::string good = line_of(9, 123000, 456000);
    for (size_t at = 0; at + 2 < good.size(); at++) {
        for (const char other : {'0', '7', ',', '*', '-', ' ', '\n', '\0'}) {
            if (good[at] != other) {
                std::string bad = good;
                bad[at] = other;
                line = {};
                EXPECT_EQ(feed(bad), 0) << bad;
                EXPECT_EQ(feed(good), 1);
            }
        }
        line = {};
        EXPECT_EQ(feed(good.substr(0, at) + good), 1) << "cut off at " << at;
    }
}

TEST_F(Line, NoiseIsNoSetPoint)
{
    std::mt19937 random(7);
    for (int k = 0; k < 1000000; k++) {
        EXPECT_FALSE(ale_motor_byte(&line, "$ALE,0123456789*-\r\n"[random() % 19], now_ms));
    }
    feed("\n");
    EXPECT_EQ(feed(line_of(1, 5000, 0)), 1);
}

} // namespace
