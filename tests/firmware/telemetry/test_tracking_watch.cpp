// firmware/telemetry/tracking_watch: what people are told of tracking, once a change.
#include <string>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include "motion/wheel_monitor.h"
#include "telemetry/tracking_watch.h"
}

namespace
{

struct Robot {
    ale_tracking_watch_t watch = {};
    int64_t now_us = 1000000000;
    std::vector<std::string> said = {};

    // So many scans, a tenth of a second apart.
    void goes_on(int scans, ale_state_t state, uint32_t map_id = 0, uint32_t lines = 8,
                 uint8_t wheel_fault = ALE_WHEELS_FINE)
    {
        for (int k = 0; k < scans; k++) {
            now_us += 100000;
            ale_estimate_t estimate = {};
            estimate.stamp_us = now_us;
            estimate.map = {1500000, -250000, 0};
            estimate.state = static_cast<uint8_t>(state);
            estimate.map_id = map_id;
            estimate.wheel_fault = wheel_fault;
            char line[ALE_TRACKING_LINE];
            if (ale_tracking_watch_take(&watch, &estimate, lines, line)) {
                said.emplace_back(line);
            }
        }
    }
};

TEST(TrackingWatch, a_robot_that_knows_where_it_is_says_nothing)
{
    Robot robot;
    robot.goes_on(5, ALE_STATE_WEAK);
    robot.goes_on(1000, ALE_STATE_GOOD);
    EXPECT_TRUE(robot.said.empty());
}

TEST(TrackingWatch, lost_is_said_at_once_with_place_cause_and_advice)
{
    Robot robot;
    robot.goes_on(20, ALE_STATE_GOOD);
    robot.goes_on(1, ALE_STATE_LOST);
    ASSERT_EQ(robot.said.size(), 1U);
    EXPECT_EQ(
        robot.said[0],
        "lost at 1.50 m, -0.25 m: nothing of what is seen is where the map has it; the map stays, a new one "
        "is drawn until a place of it is known again: drive slowly to one, or say where the robot is");
}

TEST(TrackingWatch, the_cause_is_what_is_known_of_it)
{
    Robot blind;
    blind.goes_on(1, ALE_STATE_LOST, 0, 0);
    EXPECT_NE(blind.said.at(0).find("the scanner sees no walls"), std::string::npos);
    Robot misled;
    misled.goes_on(1, ALE_STATE_LOST, 0, 8, ALE_WHEELS_STALLED);
    EXPECT_NE(misled.said.at(0).find("wheels: stalled"), std::string::npos);
}

TEST(TrackingWatch, a_map_of_its_own_is_part_of_being_lost_and_found_comes_with_how_long)
{
    Robot robot;
    robot.goes_on(20, ALE_STATE_GOOD);
    robot.goes_on(1, ALE_STATE_LOST);
    robot.goes_on(50, ALE_STATE_GOOD, 1);
    EXPECT_EQ(robot.said.size(), 1U);
    robot.goes_on(30, ALE_STATE_GOOD);
    ASSERT_EQ(robot.said.size(), 2U);
    EXPECT_EQ(robot.said[1], "found in the map at 1.50 m, -0.25 m, after 5.1 s");
}

TEST(TrackingWatch, uncertain_is_said_when_it_lasts)
{
    Robot robot;
    robot.goes_on(20, ALE_STATE_GOOD);
    robot.goes_on(29, ALE_STATE_WEAK);
    robot.goes_on(20, ALE_STATE_GOOD);
    EXPECT_TRUE(robot.said.empty());
    robot.goes_on(40, ALE_STATE_WEAK);
    robot.goes_on(20, ALE_STATE_GOOD);
    ASSERT_EQ(robot.said.size(), 2U);
    EXPECT_EQ(robot.said[0].rfind("uncertain at ", 0), 0U);
    EXPECT_EQ(robot.said[1], "certain again at 1.50 m, -0.25 m, after 4.0 s");
}

TEST(TrackingWatch, states_that_flicker_are_no_line_a_scan)
{
    Robot robot;
    for (int k = 0; k < 300; k++) {
        robot.goes_on(1, k % 3 == 0 ? ALE_STATE_LOST : ALE_STATE_GOOD);
    }
    EXPECT_EQ(robot.said.size(), 1U);
    robot.said.clear();
    for (int k = 0; k < 60; k++) {
        robot.goes_on(11, ALE_STATE_GOOD);
        robot.goes_on(1, ALE_STATE_LOST);
    }
    EXPECT_LE(robot.said.size(), 2 * 72U) << "two lines a second at most";
}

} // namespace
