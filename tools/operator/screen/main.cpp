/* ale-screen: the robot's state and map as text, for those who are on the robot by ssh. */
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "operator/console/lcm_feed.h"
#include "operator/screen/picture.h"
#include "operator/screen/robot_state.h"
#include "operator/screen/terminal.h"

namespace
{

constexpr char usage[] =
    "usage: ale-screen [--lcm-url URL] [--once]\n"
    "The robot's state and map as a text screen. Keys: f follow the robot, 0 whole map, + - zoom, q quit.\n"
    "  --lcm-url URL  where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --once         waits for pose, status and map, prints one picture on stdout and ends\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed (no terminal, no route for multicast; --once: nothing came in 10 s), 2 wrong "
    "use.\n";

constexpr int frame_ms = 100;
constexpr int once_columns = 110;
constexpr int once_rows = 36;
constexpr std::chrono::seconds once_waits{10};

struct Options {
    std::string lcm_url;
    bool once = false;
};

/* Listens for one frame. */
void listen(console::LcmFeed &feed, text_screen::RobotState &state)
{
    const auto end = text_screen::RobotState::Clock::now() + std::chrono::milliseconds(frame_ms);
    for (auto now = end - std::chrono::milliseconds(frame_ms); now < end;
         now = text_screen::RobotState::Clock::now()) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - now).count();
        feed.wait(static_cast<int>(left) + 1);
    }
    state.malformed = feed.malformed();
}

void print_once(console::LcmFeed &feed, text_screen::RobotState &state)
{
    const auto end = text_screen::RobotState::Clock::now() + once_waits;
    while (!(state.pose && state.status && state.map.num_lines > 0) &&
           text_screen::RobotState::Clock::now() < end && !cli::interrupted()) {
        listen(feed, state);
    }
    if (!state.pose) {
        throw std::runtime_error("no robot heard");
    }
    for (const auto &row :
         text_screen::picture(state, text_screen::RobotState::Clock::now(), {}, once_columns, once_rows)) {
        for (const auto &span : row.spans) {
            std::fputs(span.text.c_str(), stdout);
        }
        std::putchar('\n');
    }
}

/* False: the operator has seen enough. */
bool take_key(int key, text_screen::Look &look)
{
    constexpr double nearer = 1.25;
    switch (key) {
    case 'q':
        return false;
    case 'f':
        look.follow = true;
        break;
    case '0':
        look.follow = false;
        break;
    case '+':
    case '=':
        look.follow = true;
        look.metres_across = std::max(0.5, look.metres_across / nearer);
        break;
    case '-':
        look.follow = true;
        look.metres_across = std::min(500.0, look.metres_across * nearer);
        break;
    default:
        break;
    }
    return true;
}

void watch(console::LcmFeed &feed, text_screen::RobotState &state)
{
    text_screen::Terminal terminal;
    text_screen::Look look;
    while (!cli::interrupted() && take_key(terminal.key(), look)) {
        terminal.show(text_screen::picture(state, text_screen::RobotState::Clock::now(), look,
                                           terminal.columns(), terminal.rows()));
        listen(feed, state);
    }
}

void run(const Options &options)
{
    console::LcmFeed feed(options.lcm_url);
    text_screen::RobotState state;
    state.subscribe(feed);
    if (options.once) {
        print_once(feed, state);
    } else {
        watch(feed, state);
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-screen", usage);
    line.text("lcm-url", options.lcm_url);
    line.flag("once", options.once);
    return line.run(argc, argv, [&] {
        cli::catch_interrupts();
        run(options);
    });
}
