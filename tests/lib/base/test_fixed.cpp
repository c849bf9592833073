// lib/base/fixed.c against double and against 128-bit arithmetic of the compiler.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

extern "C" {
#include "base/fixed.h"
}

namespace
{

__extension__ typedef __int128 wide;

int64_t saturate(wide v)
{
    return v > INT64_MAX ? INT64_MAX : v < INT64_MIN ? INT64_MIN : static_cast<int64_t>(v);
}

wide round_half_away(wide num, wide den)
{
    const bool negative = (num < 0) != (den < 0);
    const wide n = num < 0 ? -num : num;
    const wide d = den < 0 ? -den : den;
    const wide q = (n + d / 2) / d;
    return negative ? -q : q;
}

class Numbers
{
  public:
    int64_t any(int most_bits = 63)
    {
        const int64_t v =
            static_cast<int64_t>(engine() >> (64 - 1 - engine() % static_cast<unsigned>(most_bits)));
        return engine() & 1 ? -v : v;
    }

  private:
    std::mt19937_64 engine{7};
};

TEST(Fixed, RoundsHalvesAwayFromZeroInBothDirections)
{
    EXPECT_EQ(ale_round_shift(3, 1), 2);
    EXPECT_EQ(ale_round_shift(-3, 1), -2);
    EXPECT_EQ(ale_round_shift(5, 0), 5);
    EXPECT_EQ(ale_round_div(5, 2), 3);
    EXPECT_EQ(ale_round_div(-5, 2), -3);
    EXPECT_EQ(ale_round_div(-4, 3), -1);
}

TEST(Fixed, RoundingIsOddSymmetric)
{
    Numbers numbers;
    for (int k = 0; k < 100000; k++) {
        const int64_t v = numbers.any(60);
        EXPECT_EQ(ale_round_shift(-v, 13), -ale_round_shift(v, 13));
        EXPECT_EQ(ale_round_div(-v, 1001), -ale_round_div(v, 1001));
    }
}

TEST(Fixed, BitLengthIsTheNumberOfTheHighestBit)
{
    EXPECT_EQ(ale_bit_length(0), 0u);
    for (unsigned b = 0; b < 64; b++) {
        EXPECT_EQ(ale_bit_length(uint64_t{1} << b), b + 1);
        EXPECT_EQ(ale_bit_length(UINT64_MAX >> b), 64 - b);
    }
}

TEST(Fixed, SquareRootIsTheFloor)
{
    Numbers numbers;
    for (int k = 0; k < 200000; k++) {
        const uint64_t v = static_cast<uint64_t>(std::llabs(numbers.any()));
        const wide root = ale_isqrt(v);
        EXPECT_LE(root * root, wide{0} + v);
        EXPECT_GT((root + 1) * (root + 1), wide{0} + v);
    }
    for (uint64_t root = 1; root < UINT32_MAX; root += root / 1000 + 1) {
        EXPECT_EQ(ale_isqrt(root * root), root);
        EXPECT_EQ(ale_isqrt(root * root - 1), root - 1);
    }
    EXPECT_EQ(ale_isqrt(0), 0u);
    EXPECT_EQ(ale_isqrt(UINT64_MAX), UINT32_MAX);
}

TEST(Fixed, ABillionthOfAProductIsKnownToItsUnit)
{
    Numbers numbers;
    for (int k = 0; k < 100000; k++) {
        const int64_t a = numbers.any(40);
        const int64_t b = numbers.any(32);
        const double exact = static_cast<double>(a) * static_cast<double>(b) / 1e9;
        const double bound = 1 + std::fabs(exact) * 1e-9 + std::fabs(static_cast<double>(a)) * 5e-13;
        EXPECT_NEAR(static_cast<double>(ale_mul_nano(a, b)), exact, bound) << a << " * " << b;
        EXPECT_EQ(ale_mul_nano(-a, b), -ale_mul_nano(a, b));
    }
}

TEST(Fixed, WideProductIsExactAfterTheShift)
{
    Numbers numbers;
    for (int k = 0; k < 200000; k++) {
        const int64_t a = numbers.any();
        const int64_t b = numbers.any();
        const unsigned shift = static_cast<unsigned>(std::llabs(numbers.any(6))) % 126;
        EXPECT_EQ(ale_mul_shift(a, b, shift), saturate(round_half_away(wide{a} * b, wide{1} << shift)))
            << a << " * " << b << " >> " << shift;
    }
}

TEST(Fixed, WideQuotientIsExactAndSaturates)
{
    Numbers numbers;
    for (int k = 0; k < 400000; k++) {
        const int64_t a = numbers.any();
        const int64_t b = numbers.any();
        const int64_t c = numbers.any();
        if (c != 0) {
            EXPECT_EQ(ale_mul_div(a, b, c), saturate(round_half_away(wide{a} * b, c)))
                << a << " * " << b << " / " << c;
        }
    }
    EXPECT_EQ(ale_mul_div(INT64_MAX, INT64_MAX, 1), INT64_MAX);
    EXPECT_EQ(ale_mul_div(INT64_MAX, INT64_MAX, -1), INT64_MIN);
}

} // namespace
