#include "operator/watch/live_screen.h"

#include <algorithm>

namespace watch
{

bool LiveScreen::take_key()
{
    constexpr double zoom = 1.25;
    switch (terminal_.key()) {
    case 'q':
        return false;
    case 'f':
        view_.follow = true;
        break;
    case '0':
        view_.follow = false;
        break;
    case '+':
    case '=':
        view_.follow = true;
        view_.metres_across = std::max(0.5, view_.metres_across / zoom);
        break;
    case '-':
        view_.follow = true;
        view_.metres_across = std::min(500.0, view_.metres_across * zoom);
        break;
    default:
        break;
    }
    return true;
}

bool LiveScreen::show(const RobotState &state)
{
    if (!take_key()) {
        return false;
    }
    terminal_.show(
        screen_rows(state, RobotState::Clock::now(), view_, terminal_.columns(), terminal_.rows()));
    return true;
}

std::string printed_screen(const RobotState &state)
{
    constexpr int columns = 110;
    constexpr int rows = 36;
    std::string text;
    for (const Row &row : screen_rows(state, RobotState::Clock::now(), {}, columns, rows)) {
        for (const Span &span : row.spans) {
            text += span.text;
        }
        text += '\n';
    }
    return text;
}

} // namespace watch
