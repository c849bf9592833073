// lib/extract/lowess.c and histogram.c against the twin in double and against sorting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/robust_lowess.h"

extern "C" {
#include "base/histogram.h"
#include "extract/lowess.h"
}

namespace
{

struct segment {
    std::vector<uint16_t> beam;
    std::vector<int32_t> value;
};

segment wavy(std::mt19937 &engine, int count, bool gaps, bool outliers)
{
    std::normal_distribution<double> gauss(0, 2000);
    segment s;
    uint16_t beam = 5;
    for (int i = 0; i < count; i++) {
        beam = static_cast<uint16_t>(beam + (gaps && engine() % 20 == 0 ? 3 : 1));
        double v = 8e6 + 3e5 * std::cos(beam * 0.01) + gauss(engine);
        v += outliers && i % 25 == 12 ? 3e5 : 0; // fewer than half of any window
        s.beam.push_back(beam);
        s.value.push_back(static_cast<int32_t>(v));
    }
    return s;
}

std::vector<int32_t> smooth(const segment &s, int span, int passes)
{
    static ale_lowess_work_t work;
    const ale_lowess_config_t config = {static_cast<uint16_t>(span), static_cast<uint8_t>(passes), 100};
    std::vector<int32_t> out(s.value.size());
    ale_lowess(&config, s.beam.data(), s.value.data(), static_cast<int32_t>(s.value.size()), out.data(),
               &work);
    return out;
}

std::vector<double> twin(const segment &s, int span, int passes)
{
    return reference::robust_lowess(span, passes, 100)(std::vector<int>(s.beam.begin(), s.beam.end()),
                                                       std::vector<double>(s.value.begin(), s.value.end()));
}

TEST(Lowess, AgreesWithTheTwinWithoutRobustPasses)
{
    std::mt19937 engine(1);
    for (const int span : {3, 5, 7, 11, 31}) {
        for (int trial = 0; trial < 20; trial++) {
            const segment s = wavy(engine, 3 + static_cast<int>(engine() % 200), trial % 2 == 0, false);
            const auto got = smooth(s, span, 0);
            const auto expected = twin(s, span, 0);
            for (size_t i = 0; i < got.size(); i++) {
                EXPECT_NEAR(got[i], expected[i], 150) << span << " " << i; // weights have 8 bits
            }
        }
    }
}

TEST(Lowess, AgreesWithTheTwinAfterRobustPasses)
{
    std::mt19937 engine(2);
    for (int trial = 0; trial < 40; trial++) {
        const segment s = wavy(engine, 150, false, true);
        const auto got = smooth(s, 11, 3);
        const auto expected = twin(s, 11, 3);
        for (size_t i = 0; i < got.size(); i++) {
            EXPECT_NEAR(got[i], expected[i], 900) << i; // the median is counted in bins
        }
    }
}

TEST(Lowess, AnOutlierDoesNotMoveItsNeighbours)
{
    std::mt19937 engine(3);
    segment clean = wavy(engine, 101, false, false);
    segment spoilt = clean;
    spoilt.value[50] += 500000;
    const auto a = smooth(clean, 11, 3);
    const auto b = smooth(spoilt, 11, 3);
    for (size_t i = 40; i <= 60; i++) {
        EXPECT_NEAR(a[i], b[i], 2500) << i;
    }
    EXPECT_GT(smooth(spoilt, 11, 0)[50] - a[50], 20000);
}

TEST(Lowess, AMirroredSegmentGivesTheMirroredResult)
{
    std::mt19937 engine(4);
    for (int trial = 0; trial < 20; trial++) {
        const segment s = wavy(engine, 120, true, true);
        segment m;
        for (size_t i = s.beam.size(); i-- > 0;) {
            m.beam.push_back(static_cast<uint16_t>(1000 - s.beam[i]));
            m.value.push_back(s.value[i]);
        }
        const auto forward = smooth(s, 9, 2);
        auto backward = smooth(m, 9, 2);
        std::reverse(backward.begin(), backward.end());
        EXPECT_EQ(forward, backward);
    }
}

TEST(Lowess, EqualValuesAndShortSegmentsStayAsTheyAre)
{
    segment s;
    for (uint16_t k = 0; k < 40; k++) {
        s.beam.push_back(k);
        s.value.push_back(123456);
    }
    EXPECT_EQ(smooth(s, 11, 3), s.value);
    for (const size_t count : {size_t{0}, size_t{1}, size_t{2}}) {
        const segment head = {{s.beam.begin(), s.beam.begin() + static_cast<long>(count)},
                              {s.value.begin(), s.value.begin() + static_cast<long>(count)}};
        EXPECT_EQ(smooth(head, 11, 3), head.value);
    }
}

TEST(Histogram, QuantilesAreWithinThreePercentOfSorting)
{
    std::mt19937 engine(5);
    for (const double scale : {300.0, 5000.0, 2e6}) {
        std::normal_distribution<double> gauss(0, scale);
        std::vector<uint64_t> values;
        uint16_t bins[ALE_HISTOGRAM_BINS] = {};
        for (int k = 0; k < 20000; k++) {
            values.push_back(static_cast<uint64_t>(std::fabs(gauss(engine))));
            bins[ale_histogram_bin(values.back())]++;
        }
        std::sort(values.begin(), values.end());
        for (const int percent : {25, 50, 75}) {
            const double exact =
                static_cast<double>(values[values.size() * static_cast<size_t>(percent) / 100]);
            EXPECT_NEAR(static_cast<double>(ale_histogram_quantile(bins, 20000, percent)) / exact, 1.0, 0.03);
        }
    }
}

TEST(Histogram, TheLastBinTakesWhatIsTooLarge)
{
    EXPECT_EQ(ale_histogram_bin(UINT64_MAX / 2), static_cast<uint32_t>(ALE_HISTOGRAM_BINS - 1));
    EXPECT_EQ(ale_histogram_bin(0), 0u);
}

} // namespace
