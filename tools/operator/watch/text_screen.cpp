#include "operator/watch/text_screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/export/formatted.h"
#include "operator/watch/braille.h"

namespace watch
{

namespace
{

constexpr int numbers_columns = 37;
constexpr int label_columns = 13;
constexpr int most_rows = 4;      /* of one thing said */
constexpr double silence_s = 0.7; /* a URG gives ten scans a second */
constexpr double degrees = 180 / M_PI;

/* ASCII only, cut or filled up to so many cells. */
std::string fit(std::string text, int columns)
{
    for (char &c : text) {
        c = c < ' ' || c > '~' ? '?' : c;
    }
    text.resize(static_cast<size_t>(std::max(columns, 0)), ' ');
    return text;
}

struct Standing {
    const char *word;
    Mood mood;
};

Standing standing(const RobotState &state, double age_s)
{
    if (!state.pose) {
        return {"WAITING", Mood::dim};
    }
    if (age_s > silence_s) {
        return {"LINK LOST", Mood::lost};
    }
    constexpr std::array<Standing, 3> states = {
        {{"LOST", Mood::lost}, {"WEAK", Mood::weak}, {"GOOD", Mood::good}}};
    return states[static_cast<size_t>(std::clamp<int>(state.pose->state, 0, 2))];
}

Row banner(const RobotState &state, double age_s, int columns)
{
    const Standing now = standing(state, age_s);
    const std::string robot = state.status ? state.status->robot : "";
    const std::string age = state.pose ? ale::formatted("pose %.1f s ago ", age_s) : "no robot heard yet ";
    const std::string left = ale::formatted(" %s", now.word);
    const std::string right = robot + "  " + age;
    const int gap = columns - static_cast<int>(left.size());
    std::string text = left + ale::formatted("%*s", std::max(gap, 0), right.c_str());
    return {{{fit(std::move(text), columns), now.mood}}, true};
}

/* A label and what it says, for the column at the right. */
class Numbers
{
  public:
    /* What is too long for a row goes on in the next ones, broken at spaces. */
    void say(const char *label, std::string text, Mood mood = Mood::plain)
    {
        constexpr size_t room = numbers_columns - label_columns - 1;
        for (int row = 0; row < most_rows && (row == 0 || !text.empty()); row++) {
            const size_t space = text.size() > room ? text.rfind(' ', room) : std::string::npos;
            const size_t end = space == std::string::npos || space == 0 ? room : space;
            rows_.push_back({{fit(ale::formatted(" %s", row == 0 ? label : ""), label_columns), Mood::dim},
                             {fit(text.substr(0, end), numbers_columns - label_columns), mood}});
            text.erase(0, end + (end == space));
        }
    }

    void blank()
    {
        rows_.push_back({{fit("", numbers_columns), Mood::plain}});
    }

    std::vector<std::vector<Span>> rows_;
};

void say_pose(const ale::pose_t &pose, Numbers &numbers)
{
    numbers.say("x",
                ale::formatted("%8.3f m  +- %.1f mm", pose.map_x, 1e3 * std::sqrt(std::fabs(pose.cov[0]))));
    numbers.say("y",
                ale::formatted("%8.3f m  +- %.1f mm", pose.map_y, 1e3 * std::sqrt(std::fabs(pose.cov[4]))));
    numbers.say("heading",
                ale::formatted("%8.1f    +- %.2f deg", std::remainder(pose.map_theta, 2 * M_PI) * degrees,
                               std::sqrt(std::fabs(pose.cov[8])) * degrees));
    numbers.say("moves",
                ale::formatted("%.2f m/s %.0f deg/s", std::hypot(pose.vx, pose.vy), pose.omega * degrees));
    numbers.say("scan", ale::formatted("%d%s", pose.scan, pose.predicted ? "  predicted" : ""),
                pose.predicted ? Mood::weak : Mood::plain);
}

void say_features(const RobotState &state, Numbers &numbers)
{
    const int lines = state.features ? state.features->num_lines : 0;
    const int corners = state.features ? state.features->num_corners : 0;
    numbers.say("seen", ale::formatted("%d lines, %d corners", lines, corners));
    numbers.say("map", ale::formatted("%d walls, %d corners", state.map.num_lines, state.map.num_corners));
    if (const std::string maps = state.map_trouble(); !maps.empty()) {
        numbers.say("", maps, Mood::weak);
    }
    if (const std::string wheels = state.wheel_trouble(); !wheels.empty()) {
        numbers.say("wheels", wheels + ": not believed", Mood::weak);
    }
}

void say_counters(const ale::status_t &status, Numbers &numbers)
{
    const size_t count = std::min(status.counter_name.size(), status.counter_value.size());
    for (size_t k = 0; k < count; k++) {
        if (status.counter_value[k] > 0) {
            numbers.say("",
                        ale::formatted("%7lld ", static_cast<long long>(status.counter_value[k])) +
                            status.counter_name[k],
                        Mood::dim);
        }
    }
}

void say_status(const ale::status_t &status, Numbers &numbers)
{
    numbers.say("scan takes",
                ale::formatted("%.0f us, worst %.0f", status.stage_last_us[5], status.stage_worst_us[5]));
    numbers.say("latency", ale::formatted("%.2f ms, p99 %.2f", status.latency_p50_us / 1e3,
                                          status.latency_p99_us / 1e3));
    numbers.say("deadlines", ale::formatted("%d missed", status.deadline_misses),
                status.deadline_misses > 0 ? Mood::weak : Mood::plain);
    numbers.say("real time", status.realtime ? "yes" : "no", status.realtime ? Mood::good : Mood::weak);
    numbers.say("scanner", status.driver_state);
    numbers.say("drives", status.who_drives.empty() ? "nobody" : status.who_drives);
    numbers.say("exploration", status.exploration.empty() ? "off" : status.exploration);
    if (!status.command_operator.empty()) {
        numbers.say(status.command_operator.c_str(), status.command_result,
                    status.command_obeyed ? Mood::good : Mood::lost);
    }
    numbers.blank();
    say_counters(status, numbers);
}

Numbers numbers_of(const RobotState &state)
{
    Numbers numbers;
    numbers.blank();
    if (state.pose) {
        say_pose(*state.pose, numbers);
    }
    say_features(state, numbers);
    if (state.status) {
        say_status(*state.status, numbers);
    }
    if (state.malformed > 0) {
        numbers.say("malformed",
                    ale::formatted("%llu messages", static_cast<unsigned long long>(state.malformed)),
                    Mood::weak);
    }
    return numbers;
}

/* From metres of the map to dots of the terminal. */
struct Camera {
    double x, y, dots_a_metre, middle_x, middle_y;

    double across(double map_x) const
    {
        return middle_x + (map_x - x) * dots_a_metre;
    }
    double down(double map_y) const
    {
        return middle_y - (map_y - y) * dots_a_metre;
    }
};

struct Box {
    double left = 1e9, bottom = 1e9, right = -1e9, top = -1e9;

    void take(double x, double y)
    {
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = std::min(bottom, y);
        top = std::max(top, y);
    }
};

Camera camera_of(const RobotState &state, const View &view, int columns, int rows)
{
    const double width = columns * Braille::dots_across;
    const double height = rows * Braille::dots_down;
    if (view.follow && state.pose) {
        return {state.pose->map_x, state.pose->map_y, width / view.metres_across, width / 2, height / 2};
    }
    Box box;
    for (const auto &wall : state.map.lines) {
        box.take(wall.x1, wall.y1);
        box.take(wall.x2, wall.y2);
    }
    if (state.pose) {
        box.take(state.pose->map_x, state.pose->map_y);
    }
    if (box.left > box.right) {
        box.take(0, 0);
    }
    const double scale = std::min((width - 4) / std::max(1.0, box.right - box.left),
                                  (height - 4) / std::max(1.0, box.top - box.bottom));
    return {(box.left + box.right) / 2, (box.bottom + box.top) / 2, scale, width / 2, height / 2};
}

Braille map_of(const RobotState &state, const View &view, int columns, int rows)
{
    Braille canvas(columns, rows);
    const Camera camera = camera_of(state, view, columns, rows);
    for (const auto &wall : state.map.lines) {
        canvas.line(camera.across(wall.x1), camera.down(wall.y1), camera.across(wall.x2),
                    camera.down(wall.y2));
    }
    if (state.pose) {
        static constexpr std::array<const char *, 8> arrows = {"→", "↗", "↑", "↖", "←", "↙", "↓", "↘"};
        const double eighths = std::round(state.pose->map_theta / (M_PI / 4));
        const auto arrow = static_cast<size_t>(eighths - 8 * std::floor(eighths / 8));
        canvas.mark(camera.across(state.pose->map_x), camera.down(state.pose->map_y), arrows[arrow % 8]);
    }
    return canvas;
}

} // namespace

std::vector<Row> screen_rows(const RobotState &state, RobotState::Clock::time_point now, const View &view,
                             int columns, int rows)
{
    const double age_s = std::chrono::duration<double>(now - state.pose_at).count();
    const int map_columns = std::max(columns, least_columns) - numbers_columns;
    const int map_rows = std::max(rows, least_rows) - 1;
    std::vector<Row> shown = {banner(state, age_s, map_columns + numbers_columns)};
    const Braille map = map_of(state, view, map_columns, map_rows);
    Numbers numbers = numbers_of(state);
    for (int k = 0; k < map_rows; k++) {
        Row row{{{map.row(k), Mood::plain}}, false};
        if (static_cast<size_t>(k) >= numbers.rows_.size()) {
            numbers.blank();
        }
        const auto &said = numbers.rows_[static_cast<size_t>(k)];
        row.spans.insert(row.spans.end(), said.begin(), said.end());
        shown.push_back(std::move(row));
    }
    return shown;
}

} // namespace watch
