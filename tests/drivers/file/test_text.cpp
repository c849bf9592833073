#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

extern "C" {
#include "file/text.h"
}

namespace
{

ale_span_t span(const std::string &text)
{
    return {text.data(), text.data() + text.size()};
}

int64_t decimal(const std::string &text, unsigned decimals)
{
    int64_t value = -999;
    return ale_text_decimal(span(text), decimals, &value) ? value : INT64_MIN;
}

TEST(Text, LinesAreFoundWithAndWithoutALastLineFeed)
{
    const std::string text = "one two\r\n\nthree";
    ale_text_t lines = ale_text(text.data(), text.size());
    ale_span_t line;
    ale_span_t word;
    ASSERT_TRUE(ale_text_line(&lines, &line));
    EXPECT_EQ(ale_text_count_words(line, 9), 2U);
    EXPECT_TRUE(ale_text_word(&line, &word) && ale_text_is(word, "one"));
    EXPECT_TRUE(ale_text_word(&line, &word) && ale_text_is(word, "two"));
    ASSERT_TRUE(ale_text_line(&lines, &line));
    EXPECT_EQ(ale_text_count_words(line, 9), 0U);
    ASSERT_TRUE(ale_text_line(&lines, &line));
    EXPECT_TRUE(ale_text_word(&line, &word) && ale_text_is(word, "three"));
    EXPECT_EQ(lines.line, 3U);
    EXPECT_FALSE(ale_text_line(&lines, &line));
}

TEST(Text, DecimalsAreExactAndRoundHalfAwayFromZero)
{
    EXPECT_EQ(decimal("0.145", 6), 145000);
    EXPECT_EQ(decimal("-2.5", 0), -3);
    EXPECT_EQ(decimal("2.4999", 0), 2);
    EXPECT_EQ(decimal("8e-06", 6), 8);
    EXPECT_EQ(decimal("1.5E3", 0), 1500);
    EXPECT_EQ(decimal("+.5", 1), 5);
    EXPECT_EQ(decimal("7.", 2), 700);
    EXPECT_EQ(decimal("976052857.337530", 6), 976052857337530);
    EXPECT_EQ(decimal("000000000000000000000000000012", 0), 12);
    EXPECT_EQ(decimal("1e-400", 6), 0);
}

TEST(Text, WhatIsNoNumberIsRefused)
{
    for (const char *text : {"", "-", ".", "e5", "1e", "1x", "0x10", "1.2.3", "nan", "inf", "1e400",
                             "1e99999999999", "99999999999999999999", "--1", "1 2"}) {
        EXPECT_EQ(decimal(text, 6), INT64_MIN) << text;
    }
    int32_t small = 7;
    EXPECT_FALSE(ale_text_decimal32(span("2147.483648"), 6, &small));
    EXPECT_TRUE(ale_text_decimal32(span("2147.483647"), 6, &small));
    EXPECT_EQ(small, INT32_MAX);
}

TEST(Text, ALineOfNumbersHasAllOfThemAndNoMore)
{
    const std::string text = " 7 -12\t0 \r";
    int64_t n[4] = {};
    ASSERT_TRUE(ale_text_numbers(span(text), n, 3));
    EXPECT_EQ(n[0], 7);
    EXPECT_EQ(n[1], -12);
    EXPECT_EQ(n[2], 0);
    EXPECT_FALSE(ale_text_numbers(span(text), n, 2));
    EXPECT_FALSE(ale_text_numbers(span(text), n, 4));
    const std::string word = "7 x 0";
    EXPECT_FALSE(ale_text_numbers(span(word), n, 3));
}

TEST(Text, DecimalsAgreeWithTheLongDoubleOfTheLibrary)
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> exponent(-9, 9);
    for (int i = 0; i < 20000; i++) {
        const double size = std::pow(10.0, exponent(random));
        char text[64];
        std::snprintf(text, sizeof text, i % 2 ? "%.9e" : "%.9f", (i % 3 ? 1 : -1) * size);
        const long double expected = std::strtold(text, nullptr) * 1e6L;
        EXPECT_NEAR(static_cast<double>(decimal(text, 6) - expected), 0, 0.5 + 1e-9 * std::abs(size)) << text;
    }
}

TEST(Text, AnglesOfAnyNumberOfTurnsAgreeWithDouble)
{
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> angle(-1000, 1000);
    for (int i = 0; i < 20000; i++) {
        char text[64];
        std::snprintf(text, sizeof text, "%.9f", angle(random));
        uint32_t bam = 0;
        ASSERT_TRUE(ale_text_angle(span(text), &bam));
        const double expected =
            std::remainder(std::strtod(text, nullptr), 2 * M_PI) / (2 * M_PI) * 4294967296.0;
        const auto difference = static_cast<int32_t>(bam - static_cast<uint32_t>(std::llround(expected)));
        EXPECT_LE(std::abs(difference), 1) << text;
    }
}

} // namespace
