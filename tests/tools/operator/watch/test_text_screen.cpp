#include "operator/watch/text_screen.h"

#include <gtest/gtest.h>

using namespace watch;

namespace
{

using Clock = RobotState::Clock;

RobotState driving(Clock::time_point now)
{
    RobotState state;
    state.pose.emplace();
    state.pose->state = 2;
    state.pose->map_x = 1.25F;
    state.pose->map_theta = 1.5708F;
    state.pose_at = now;
    ale::map_line_t wall{};
    wall.x1 = -2;
    wall.x2 = 4;
    wall.y1 = wall.y2 = 3;
    state.map.lines = {wall};
    state.map.num_lines = 1;
    return state;
}

std::string text_of(const Row &row)
{
    std::string text;
    for (const Span &span : row.spans) {
        text += span.text;
    }
    return text;
}

std::string text_of(const std::vector<Row> &rows)
{
    std::string text;
    for (const Row &row : rows) {
        text += text_of(row) + "\n";
    }
    return text;
}

/* Cells: every character counts one, whatever its bytes. */
int cells(const std::string &text)
{
    int count = 0;
    for (const char c : text) {
        count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }
    return count;
}

} // namespace

TEST(TextScreen, FillsTheTerminalExactlyAndNoLessThanTheLeast)
{
    const auto now = Clock::now();
    for (const auto &[columns, rows] : {std::pair{80, 24}, {200, 60}, {10, 3}}) {
        const auto shown = screen_rows(driving(now), now, {}, columns, rows);
        EXPECT_EQ(static_cast<int>(shown.size()), std::max(rows, least_rows));
        for (const Row &row : shown) {
            EXPECT_EQ(cells(text_of(row)), std::max(columns, least_columns));
        }
    }
}

TEST(TextScreen, AMapThatIsNotJoinedAndWheelsThatLieAreSaidWhileTheyAre)
{
    const auto now = Clock::now();
    RobotState state = driving(now);
    ale::tracking_t tracking{};
    tracking.maps = 1;
    tracking.wheel_word = "fine";
    state.take(tracking);
    const std::string before = text_of(screen_rows(state, now, {}, 80, 24));
    EXPECT_EQ(before.find("joined"), std::string::npos);
    EXPECT_EQ(before.find("wheels"), std::string::npos);
    tracking.maps = 2;
    tracking.map_id = 1;
    tracking.wheel_fault = 2;
    tracking.wheel_word = "stalled";
    state.take(tracking);
    const std::string after = text_of(screen_rows(state, now, {}, 80, 24));
    EXPECT_NE(after.find("new map, not joined yet"), std::string::npos) << after;
    EXPECT_NE(after.find("stalled: not believed"), std::string::npos) << after;
    tracking.map_id = 0;
    state.take(tracking);
    EXPECT_NE(text_of(screen_rows(state, now, {}, 80, 24)).find("2 maps, not joined"), std::string::npos);
}

TEST(TextScreen, StateIsTheFirstWordAndItsMood)
{
    const auto now = Clock::now();
    RobotState state = driving(now);
    const std::pair<const char *, Mood> words[] = {
        {" LOST", Mood::lost}, {" WEAK", Mood::weak}, {" GOOD", Mood::good}};
    for (int8_t k = 0; k < 3; k++) {
        state.pose->state = k;
        const Row first = screen_rows(state, now, {}, 80, 24)[0];
        EXPECT_EQ(text_of(first).rfind(words[k].first, 0), 0U);
        EXPECT_EQ(first.spans[0].mood, words[k].second);
    }
}

TEST(TextScreen, SilenceIsALostLinkWhateverTheLastPoseSaid)
{
    const auto now = Clock::now();
    const Row first = screen_rows(driving(now), now + std::chrono::seconds(1), {}, 80, 24)[0];
    EXPECT_EQ(text_of(first).rfind(" LINK LOST", 0), 0U);
    EXPECT_EQ(first.spans[0].mood, Mood::lost);
}

TEST(TextScreen, BeforeTheRobotIsHeardItWaits)
{
    EXPECT_EQ(text_of(screen_rows({}, Clock::now(), {}, 80, 24)[0]).rfind(" WAITING", 0), 0U);
}

TEST(TextScreen, RobotIsAnArrowThatPointsWhereItLooks)
{
    const auto now = Clock::now();
    RobotState state = driving(now);
    EXPECT_NE(text_of(screen_rows(state, now, {}, 80, 24)).find("↑"), std::string::npos);
    state.pose->map_theta = -100 * 2 * 3.14159265F;
    EXPECT_NE(text_of(screen_rows(state, now, {}, 80, 24)).find("→"), std::string::npos);
}

TEST(TextScreen, WhatIsNoTextDoesNotReachTheTerminal)
{
    const auto now = Clock::now();
    RobotState state = driving(now);
    state.status.emplace();
    state.status->robot = "\x1b[2Jrover";
    state.status->driver_state = "\x07 beep";
    const std::string text = text_of(screen_rows(state, now, {}, 80, 24));
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_EQ(text.find('\x07'), std::string::npos);
    EXPECT_NE(text.find("rover"), std::string::npos);
}

TEST(TextScreen, WhatIsTooLongForARowGoesOnInTheNext)
{
    const auto now = Clock::now();
    RobotState state = driving(now);
    state.status.emplace();
    state.status->driver_state = "asking who is there: hardware fault of the sensor: status 50";
    const std::string text = text_of(screen_rows(state, now, {}, 80, 24));
    const size_t first = text.find("asking who is there:");
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_NE(text.find("hardware fault of the", first), std::string::npos) << text;
    EXPECT_NE(text.find("sensor: status 50", first), std::string::npos) << text;
    state.status->driver_state = std::string(5000, 'x');
    for (const Row &row : screen_rows(state, now, {}, 80, 24)) {
        EXPECT_EQ(cells(text_of(row)), 80);
    }
}
