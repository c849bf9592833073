/* What the terminal shows: rows of text with a mood each. Pure: state and time in, rows out.
 *
 *   +------------------------------------------------+
 *   | GOOD                       rover  pose 0.1 s ago |
 *   | map, robot as an arrow       | x      1.059 m    |
 *   | ...                          | ...               |
 *   +------------------------------------------------+ */
#ifndef WATCH_TEXT_SCREEN_H
#define WATCH_TEXT_SCREEN_H

#include <string>
#include <vector>

#include "operator/watch/robot_state.h"

namespace watch
{

enum class Mood { plain, dim, good, weak, lost };

struct Span {
    std::string text;
    Mood mood = Mood::plain;
};

struct Row {
    std::vector<Span> spans;
    bool banner = false;
};

/* Where the map is looked at: the whole of it, or metres about the robot. */
struct View {
    bool follow = false;
    double metres_across = 8;
};

constexpr int least_columns = 60;
constexpr int least_rows = 16;

/* Exactly `rows` rows of `columns` cells (at least the least ones). */
std::vector<Row> screen_rows(const RobotState &state, RobotState::Clock::time_point now, const View &view,
                             int columns, int rows);

} // namespace watch

#endif
