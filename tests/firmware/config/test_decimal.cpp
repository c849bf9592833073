#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

extern "C" {
#include "config/decimal.h"
}

namespace
{

int64_t parse(const std::string &text, unsigned digits)
{
    int64_t value = -777;
    EXPECT_EQ(ale_decimal_parse(text.c_str(), digits, &value), 0) << text;
    return value;
}

std::string print(int64_t value, unsigned digits)
{
    char text[ALE_DECIMAL_TEXT];
    ale_decimal_print(value, digits, text);
    return text;
}

TEST(Decimal, NumbersAreScaledExactly)
{
    EXPECT_EQ(parse("0.145", 6), 145000);
    EXPECT_EQ(parse("-3", 3), -3000);
    EXPECT_EQ(parse("+.5", 1), 5);
    EXPECT_EQ(parse("7.", 0), 7);
    EXPECT_EQ(parse("-0.000001", 6), -1);
    EXPECT_EQ(parse("1000000000", 9), 1000000000000000000);
}

TEST(Decimal, WhatLiesBeyondTheDigitsIsRoundedHalfAwayFromZero)
{
    EXPECT_EQ(parse("0.0000005", 6), 1);
    EXPECT_EQ(parse("-0.0000005", 6), -1);
    EXPECT_EQ(parse("0.00000049999999999999999999", 6), 0);
    EXPECT_EQ(parse("9.99", 1), 100);
    EXPECT_EQ(parse("1.5", 0), 2);
}

TEST(Decimal, WhatIsNoNumberIsRefusedAndLeavesTheOutputAlone)
{
    for (const char *text : {"", "-", ".", "1e3", "1,5", "0x10", " 1", "1 ", "nan", "inf", "--1", "1.2.3",
                             "2000000000", "99999999999999999999999999"}) {
        int64_t value = 42;
        EXPECT_EQ(ale_decimal_parse(text, 6, &value), -1) << '"' << text << '"';
        EXPECT_EQ(value, 42);
    }
}

TEST(Decimal, PrintingHasNoSuperfluousZeros)
{
    EXPECT_EQ(print(145000, 6), "0.145");
    EXPECT_EQ(print(-1, 9), "-0.000000001");
    EXPECT_EQ(print(3000, 3), "3");
    EXPECT_EQ(print(0, 6), "0");
    EXPECT_EQ(print(1200, 0), "1200");
}

TEST(Decimal, WhatIsPrintedReadsBackTheSame)
{
    std::mt19937_64 random(1);
    for (int k = 0; k < 20000; k++) {
        const unsigned digits = static_cast<unsigned>(random() % 10);
        const int64_t limit = static_cast<int64_t>(std::pow(10, digits)) * 1000;
        const int64_t value = static_cast<int64_t>(random() % static_cast<uint64_t>(2 * limit)) - limit;
        EXPECT_EQ(parse(print(value, digits), digits), value);
    }
}

TEST(Decimal, RoundingKeepsTheScale)
{
    EXPECT_EQ(ale_decimal_round(1234567, 6, 2), 1230000);
    EXPECT_EQ(ale_decimal_round(-1235000, 6, 2), -1240000);
    EXPECT_EQ(ale_decimal_round(77, 6, 6), 77);
}

} // namespace
