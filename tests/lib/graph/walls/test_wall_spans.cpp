// lib/graph/walls/wall_spans: spans of walls by the lines that cover them.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "graph/walls/wall_spans.h"
#include "lib/graph/placed_lines.hpp"

using placed_lines::line;

namespace
{

std::vector<ale::WallSpan> spans(const std::vector<ale::PlacedLine> &lines)
{
    return ale::spans_of(ale::group_lines(lines), lines, {});
}

double length_m(const ale::WallSpan &span)
{
    return static_cast<double>(int64_t{span.wall.end_um} - span.wall.start_um) * 1e-6;
}

void add_scans(std::vector<ale::PlacedLine> *lines, uint32_t scans, double from_m, double to_m)
{
    for (uint32_t k = 0; k < scans; k++) {
        const auto scan = static_cast<uint32_t>(lines->size());
        lines->push_back(line(scan, 70, from_m, to_m, 0));
    }
}

// Beams all round, each of this length.
std::unique_ptr<ale_seen_copy_t> beams_of(int32_t range_um)
{
    auto seen = std::make_unique<ale_seen_copy_t>();
    ale_scan_t &scan = seen->scan;
    scan.beams = 720;
    scan.step_bam = ALE_BAM_PER_DEGREE / 2;
    scan.range_max_um = 4000000;
    std::fill_n(scan.range_um, scan.beams, range_um);
    std::fill_n(scan.flag, scan.beams, uint8_t{ALE_BEAM_VALID});
    return seen;
}

// A wall that faces along y, shown by ten scans of a drive; a later one sees it three times from a metre.
size_t walls_left(int32_t sensor_y_um, int32_t range_um)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 10; k++) {
        lines.push_back(line(k, 90, -0.2, 0.2, 0));
    }
    const auto seen = beams_of(range_um);
    const std::vector<ale::PlacedScan> later(3, {seen.get(), {0, sensor_y_um, 0}, 1});
    return ale::spans_of(ale::group_lines(lines), lines, later).size();
}

TEST(WallSpans, WhatBeamsPassThroughFromEitherSideIsGone)
{
    for (const int32_t sensor_y_um : {1000000, -1000000}) {
        EXPECT_EQ(walls_left(sensor_y_um, 3000000), 0U) << sensor_y_um;
        EXPECT_EQ(walls_left(sensor_y_um, 1000000), 1U) << sensor_y_um;
    }
}

TEST(WallSpans, FewerThanThreeScansShowNoWall)
{
    std::vector<ale::PlacedLine> lines;
    add_scans(&lines, 2, 0, 2);
    EXPECT_TRUE(spans(lines).empty());
    add_scans(&lines, 1, 0, 2);
    const std::vector<ale::WallSpan> whole = spans(lines);
    ASSERT_EQ(whole.size(), 1U);
    EXPECT_EQ(whole[0].scans, 3U);
    EXPECT_NEAR(length_m(whole[0]), 2, 0.06);
}

// Less than a doorway behind where it stood: both cannot be there.
TEST(WallSpans, OfAWallThatWasMovedTheLaterPlaceStays)
{
    for (const double moved_mm : {-200.0, 200.0}) {
        std::vector<ale::PlacedLine> lines;
        add_scans(&lines, 20, 0, 2);
        for (uint32_t k = 0; k < 5; k++) {
            lines.push_back(line(20 + k, 70, 0, 2, moved_mm));
            lines.back().drive = 1;
        }
        const std::vector<ale::WallSpan> left = spans(lines);
        ASSERT_EQ(left.size(), 1U) << moved_mm;
        EXPECT_EQ(left[0].scans, 5U) << moved_mm;
    }
}

TEST(WallSpans, AnEndSeenByOneScanIsCut)
{
    std::vector<ale::PlacedLine> lines;
    add_scans(&lines, 10, 0, 2);
    add_scans(&lines, 1, 0, 3);
    const std::vector<ale::WallSpan> cut = spans(lines);
    ASSERT_EQ(cut.size(), 1U);
    EXPECT_NEAR(length_m(cut[0]), 2, 0.06);
}

TEST(WallSpans, SmallGapsAreClosedAndDoorsAreNot)
{
    for (const double gap_m : {0.1, 0.9}) {
        std::vector<ale::PlacedLine> lines;
        add_scans(&lines, 10, 0, 1);
        add_scans(&lines, 10, 1 + gap_m, 2 + gap_m);
        add_scans(&lines, 1, 0, 2 + gap_m); // one scan has taken both for one
        EXPECT_EQ(spans(lines).size(), gap_m < 0.5 ? 1U : 2U) << gap_m;
    }
}

TEST(WallSpans, OfTwoWallsThatCrossAtAFlatAngleTheOneWithMoreScansStays)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 70, 0, 3, 0));
    }
    for (uint32_t k = 20; k < 26; k++) {
        lines.push_back(line(k, 70, 1.3, 1.7, 20, 400));
    }
    ASSERT_EQ(ale::group_lines(lines).size(), 2U);
    const std::vector<ale::WallSpan> left = spans(lines);
    ASSERT_EQ(left.size(), 1U);
    EXPECT_NEAR(length_m(left[0]), 3, 0.06);
}

TEST(WallSpans, ACornerKeepsBothItsWalls)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 90, 0, 2, 0));
        lines.push_back(line(k, 180, 0, 2, 0));
    }
    EXPECT_EQ(spans(lines).size(), 2U);
}

} // namespace
