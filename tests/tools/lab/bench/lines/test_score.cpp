// The benchmark's own judgement: truth scores itself perfectly, each kind of mistake is seen, the textbook
// extractors find what is plain to see.
#include <gtest/gtest.h>

#include "lab/bench/lines/extractors.hpp"
#include "lab/bench/lines/repeatability.hpp"
#include "lab/bench/lines/score.hpp"
#include "lab/bench/lines/textbook/textbook.hpp"
#include "lab/bench/suite.hpp"

namespace
{

using namespace bench;

Line as_extracted(const TrueLine &line)
{
    return {line.first, line.last, line.form, line.start, line.end};
}

Extraction truth_as_extraction(const Truth &truth)
{
    Extraction extraction;
    for (const TrueLine &line : truth.lines) {
        extraction.lines.push_back(as_extracted(line));
    }
    for (const TrueCorner &corner : truth.corners) {
        extraction.corners.push_back(corner.p);
    }
    return extraction;
}

// A wall of 100 beams, straight ahead at 2 m.
Truth one_wall()
{
    TrueLine wall;
    wall.first = 290;
    wall.last = 389;
    wall.points = 100;
    wall.form = {0, 2};
    wall.start = {2, -0.63};
    wall.end = {2, 0.61};
    wall.start_between = {-0.63, -0.64};
    wall.end_between = {0.61, 0.62};
    wall.information = {1e5, 0, 1e6};
    wall.counts = true;
    Truth truth;
    truth.lines.push_back(wall);
    return truth;
}

TEST(Score, the_truth_itself_is_perfect_in_every_world_under_every_noise)
{
    for (const Noise &noise : noise_kinds()) {
        for_each_case(noise, 2, 7, [&](const Case &c) {
            const Tally tally = score(c.truth, truth_as_extraction(c.truth));
            EXPECT_EQ(tally.found_lines, tally.true_lines) << noise.name << " scan " << c.number;
            EXPECT_EQ(tally.false_lines, 0) << noise.name << " scan " << c.number;
            EXPECT_EQ(tally.found_corners, tally.true_corners);
            for (const double e : tally.error_squared) {
                EXPECT_LT(e, 1e-9);
            }
            for (const double e : tally.end_error) {
                EXPECT_LT(e, 1e-9);
            }
        });
    }
}

TEST(Score, every_kind_of_world_has_lines_to_find)
{
    std::map<std::string, int> lines;
    for_each_case(noise_kind("3mm"), 3, 11, [&](const Case &c) {
        for (const TrueLine &line : c.truth.lines) {
            lines[c.truth.kind] += line.counts;
        }
    });
    for (const std::string &kind : world_kinds()) {
        EXPECT_GE(lines[kind], 6) << kind;
    }
}

// Noise does not bring a wall nearer than it is: the truth ends at the reach, and so must the scan.
TEST(Simulation, what_lies_beyond_the_reach_gives_no_value)
{
    int beyond = 0;
    for_each_case(noise_kind("urg"), 4, 11, [&](const Case &c) {
        for (int k = 1; k + 1 < urg_beams; k++) {
            const auto out = [&](int beam) {
                return c.simulated.hits[static_cast<std::size_t>(beam)].range > urg_reach;
            };
            if (out(k - 1) && out(k) && out(k + 1)) { // a bearing errs by less than a beam
                beyond++;
                EXPECT_NE(c.simulated.scan->flag[k], ALE_BEAM_VALID) << "scan " << c.number << ", beam " << k;
            }
        }
    });
    EXPECT_GT(beyond, 500);
}

TEST(Score, a_corner_is_listed_once_though_something_hides_a_piece_of_its_wall)
{
    for_each_case(noise_kind("3mm"), 4, 3, [&](const Case &c) {
        for (std::size_t i = 0; i < c.truth.corners.size(); i++) {
            for (std::size_t j = i + 1; j < c.truth.corners.size(); j++) {
                EXPECT_GT((c.truth.corners[i].p - c.truth.corners[j].p).norm(), 1e-3) << "scan " << c.number;
            }
        }
    });
}

TEST(Score, nothing_extracted_finds_nothing_and_is_not_wrong)
{
    const Tally tally = score(one_wall(), {});
    EXPECT_EQ(tally.true_lines, 1);
    EXPECT_EQ(tally.found_lines, 0);
    EXPECT_EQ(tally.judged_lines, 0);
}

TEST(Score, two_thirds_of_a_wall_is_a_miss_and_a_false_line)
{
    Line part = as_extracted(one_wall().lines[0]);
    part.last = part.first + 66;
    part.end = {2, 0.2};
    const Tally tally = score(one_wall(), {{part}, {}});
    EXPECT_EQ(tally.found_lines, 0);
    EXPECT_EQ(tally.false_lines, 1);
}

TEST(Score, a_line_that_is_turned_or_displaced_too_far_is_false)
{
    Line turned = as_extracted(one_wall().lines[0]);
    turned.form.alpha = radians(11);
    EXPECT_EQ(score(one_wall(), {{turned}, {}}).false_lines, 1);
    Line displaced = as_extracted(one_wall().lines[0]);
    displaced.form.rho = 2.11;
    EXPECT_EQ(score(one_wall(), {{displaced}, {}}).false_lines, 1);
}

TEST(Score, a_line_found_twice_counts_once)
{
    const Line line = as_extracted(one_wall().lines[0]);
    const Tally tally = score(one_wall(), {{line, line}, {}});
    EXPECT_EQ(tally.found_lines, 1);
    EXPECT_EQ(tally.false_lines, 1);
}

TEST(Score, errors_are_measured_in_units_of_the_bound)
{
    Line off = as_extracted(one_wall().lines[0]);
    off.form.rho = 2.001; // the bound on rho is 1 mm
    const Tally tally = score(one_wall(), {{off}, {}});
    ASSERT_EQ(tally.error_squared.size(), 1u);
    EXPECT_NEAR(tally.error_squared[0], 1, 1e-6);
}

TEST(Score, ends_count_only_outside_of_where_the_wall_may_end)
{
    Line longer = as_extracted(one_wall().lines[0]);
    longer.start = {2, -0.635};
    longer.end = {2, 0.65};
    const Tally tally = score(one_wall(), {{longer}, {}});
    ASSERT_EQ(tally.end_error.size(), 2u);
    EXPECT_NEAR(tally.end_error[0], 0, 1e-12);
    EXPECT_NEAR(tally.end_error[1], 0.03, 1e-12);
}

TEST(Repeatability, the_same_lines_in_every_scan_are_walls_without_stray)
{
    const Line line = as_extracted(one_wall().lines[0]);
    const Repeatability r = repeatability(std::vector<std::vector<Line>>(20, {line}));
    EXPECT_EQ(r.walls, 1);
    EXPECT_DOUBLE_EQ(r.seen, 100);
    EXPECT_DOUBLE_EQ(r.pieces, 1);
    EXPECT_DOUBLE_EQ(r.stray, 0);
    EXPECT_DOUBLE_EQ(r.end_rms, 0);
}

TEST(Repeatability, a_wall_cut_in_two_and_a_line_seen_once_are_noticed)
{
    const Line whole = as_extracted(one_wall().lines[0]);
    Line left = whole;
    left.last = 335;
    Line right = whole;
    right.first = 336;
    std::vector<std::vector<Line>> scans(20, {left, right});
    Line elsewhere = whole;
    elsewhere.form.alpha = 1;
    scans[3].push_back(elsewhere);
    const Repeatability r = repeatability(scans);
    EXPECT_NEAR(r.pieces * r.walls, 2, 1e-12);
    EXPECT_NEAR(r.stray, 1.0 / 20, 1e-12);
}

// Without noise three walls and nothing else: every method must see them.
class Textbook : public testing::TestWithParam<std::string>
{
};

TEST_P(Textbook, finds_the_walls_of_a_plain_room)
{
    World world;
    world.walls = {{{2, -1.5}, {2, 1.6}}, {{2, 1.6}, {-1.8, 1.6}}, {{-1.8, -1.5}, {2, -1.5}}};
    Noise noise;
    noise.own_floor = 0.001;
    Random random(3);
    const SimulatedScan simulated = simulate(world, noise, random);
    const Truth truth = make_truth(world, noise, simulated);
    for (const Extractor &extractor : extractors()) {
        if (extractor.name.rfind(GetParam(), 0) == 0) {
            const Tally tally = score(truth, extractor.extract(*simulated.scan));
            EXPECT_EQ(tally.found_lines, 3) << extractor.name;
            EXPECT_EQ(tally.false_lines, 0) << extractor.name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Textbook,
                         testing::Values("ale", "split-merge", "incremental", "ransac", "hough",
                                         "regression-30mm", "static-ale"));

} // namespace
