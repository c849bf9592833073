// A recorded log played: scans in their steps, paced by the stamps, odometry in between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "files.hpp"
#include "lab/sim/log_source.h"

namespace
{

class Played : public ::testing::Test
{
  protected:
    void write(const std::string &text) const
    {
        std::ofstream(path) << text;
    }

    const files::TemporaryFolder folder;
    const std::string path = folder / "played.log";
};

/* Three beams straight ahead of a scanner with the URG's steps: steps 383 to 385. */
std::string urg_line(double t, const std::string &ranges = "1.000 0.000 1.234", double x = 0)
{
    char text[400];
    std::snprintf(text, sizeof text,
                  "ROBOTLASER1 4 -0.006135923 0.012271846 0.006135923 5.6 0.01 0 3 %s 0 "
                  "%.3f 0 0 %.3f 0 0 0 0 0 0 0 %.6f sim %.6f\n",
                  ranges.c_str(), x, x, t, t);
    return text;
}

std::vector<sim::Turn> turns(sim::LogSource &source, size_t most = 100)
{
    std::vector<sim::Turn> out;
    while (out.size() < most && source.due_us()) {
        const sim::Event event = source.next();
        if (const auto *turn = std::get_if<sim::Turn>(&event)) {
            out.push_back(*turn);
        }
    }
    return out;
}

TEST_F(Played, beams_lie_in_the_steps_of_their_bearings)
{
    write(urg_line(10.0));
    sim::LogSource source(path, true);
    const auto played = turns(source);
    ASSERT_EQ(played.size(), 1u);
    EXPECT_EQ(source.scanner().turn_steps, 1024);
    EXPECT_EQ(played[0].value_mm[383], 1000);
    EXPECT_EQ(played[0].value_mm[384], 0);
    EXPECT_EQ(played[0].value_mm[385], 1234);
    EXPECT_EQ(played[0].value_mm[382], 19);
}

TEST_F(Played, stamps_are_those_of_the_log_and_pace_the_scans)
{
    write(urg_line(10.0) + urg_line(10.13) + urg_line(10.2) + urg_line(10.1) + urg_line(10.25) +
          urg_line(29.75));
    sim::LogSource source(path, true);
    std::vector<int64_t> starts;
    std::vector<int64_t> stamps;
    for (const sim::Turn &turn : turns(source)) {
        starts.push_back(turn.start_us);
        stamps.push_back(turn.recorded_us);
    }
    EXPECT_EQ(stamps, (std::vector<int64_t>{0, 130000, 200000, 100000, 250000, 19750000}));
    EXPECT_TRUE(std::is_sorted(starts.begin(), starts.end()))
        << "a scanner sends in the order in which it measures";
    EXPECT_EQ(starts[1], 130000);
    EXPECT_EQ(starts[5], 19750000);
    ASSERT_TRUE(source.scanner().recorded);
    EXPECT_EQ(source.scanner().recorded->longest_gap_us, 19500000);
}

TEST_F(Played, a_clock_that_was_set_and_a_long_pause_are_three_seconds)
{
    write(urg_line(10.0) + urg_line(99) + urg_line(99.1) + urg_line(97) + urg_line(97.1));
    sim::LogSource source(path, true);
    std::vector<int64_t> stamps;
    for (const sim::Turn &turn : turns(source)) {
        stamps.push_back(turn.recorded_us);
    }
    EXPECT_EQ(stamps, (std::vector<int64_t>{0, 3000000, 3100000, 6100000, 6200000}));
}

TEST_F(Played, equal_stamps_keep_a_microsecond)
{
    write(urg_line(10.0) + urg_line(10.0) + urg_line(10.1));
    sim::LogSource source(path, true);
    const auto played = turns(source);
    EXPECT_EQ(played[1].recorded_us, 1);
    EXPECT_EQ(played[2].recorded_us, 100000);
}

TEST_F(Played, scans_and_odometry_go_out_in_the_order_of_the_log)
{
    const auto odom = [](double t) {
        char text[100];
        std::snprintf(text, sizeof text, "ODOM %.3f 0 0 0 0 0 %.3f sim %.3f\n", t, t, t);
        return std::string(text);
    };
    const auto blank = [](double t) { return urg_line(t, "1 1 1", 0); };
    write(odom(9.9) + blank(10.0) + odom(10.02) + odom(10.08) + blank(10.1) + odom(10.0) + blank(10.3));
    sim::LogSource source(path, true, 20);
    std::string order;
    int64_t before_us = -1000000;
    while (source.due_us()) {
        EXPECT_GE(*source.due_us(), before_us);
        before_us = *source.due_us();
        const sim::Event event = source.next();
        order += std::holds_alternative<sim::Turn>(event) ? 's' : 'o';
        if (source.due_us() && std::holds_alternative<sim::Turn>(event)) {
            EXPECT_GT(*source.due_us(), before_us) << "what follows a scan does not overtake it";
        }
    }
    EXPECT_EQ(order, "osoosos");
}

TEST_F(Played, odometry_of_a_line_has_the_scans_time_and_comes_before_it)
{
    write(urg_line(10.0, "1 1 1", 0.5) + urg_line(10.1, "1 1 1", 0.7));
    sim::LogSource source(path, true);
    std::vector<std::pair<int64_t, double>> reports;
    while (source.due_us()) {
        const sim::Event event = source.next();
        if (const auto *report = std::get_if<sim::OdometryReport>(&event)) {
            reports.emplace_back(report->stamp_us, report->pose.x);
        }
    }
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0].first, 0);
    EXPECT_NEAR(reports[0].second, 0.5, 1e-6);
    EXPECT_EQ(reports[1].first, 100000);
}

TEST_F(Played, another_scanner_answers_with_its_own_steps)
{
    std::string line = "FLASER 181";
    for (int k = 0; k < 181; k++) {
        line += k == 90 ? " 7.5" : " 81.83";
    }
    write(line + " 0 0 0 0 0 0 5.0 host 5.0\n");
    sim::LogSource source(path, true);
    EXPECT_EQ(source.scanner().turn_steps, 360);
    EXPECT_EQ(source.scanner().first_step, 0);
    EXPECT_EQ(source.scanner().last_step, 180);
    EXPECT_EQ(source.scanner().front_step, 90);
    EXPECT_GT(source.scanner().max_mm, 7500);
    const auto played = turns(source);
    ASSERT_EQ(played.size(), 1u);
    EXPECT_EQ(played[0].value_mm[90], 7500);
    EXPECT_EQ(played[0].value_mm[0], 0);
}

TEST_F(Played, without_once_the_last_scan_goes_on)
{
    write(urg_line(10.0) + urg_line(10.1, "2 2 2"));
    sim::LogSource source(path, false);
    const auto played = turns(source, 5);
    ASSERT_EQ(played.size(), 5u);
    EXPECT_EQ(played[4].value_mm[384], 2000);
    EXPECT_EQ(played[4].start_us, 400000);
    EXPECT_EQ(played[4].number, 4u);
}

TEST_F(Played, a_log_without_scans_is_refused)
{
    write("# nothing\n");
    EXPECT_THROW(sim::LogSource(path, true), std::runtime_error);
    EXPECT_THROW(sim::LogSource("no/such/log", true), std::runtime_error);
}

} // namespace
