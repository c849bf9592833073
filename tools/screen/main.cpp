/* ale-screen: the robot's state and map as text, for those who are on the robot by ssh. */
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include <getopt.h>

#include "console/lcm_feed.h"
#include "screen/picture.h"
#include "screen/robot_state.h"
#include "screen/terminal.h"

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

std::atomic<bool> interrupted{false};

/* The exit code when the command line has been answered already, else -1. */
int parse(int argc, char **argv, Options &options)
{
    static const option known[] = {{"lcm-url", required_argument, nullptr, 'l'},
                                   {"once", no_argument, nullptr, 'o'},
                                   {"help", no_argument, nullptr, 'h'},
                                   {"version", no_argument, nullptr, 'v'},
                                   {nullptr, 0, nullptr, 0}};
    for (int choice; (choice = getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        switch (choice) {
        case 'l':
            options.lcm_url = optarg;
            break;
        case 'o':
            options.once = true;
            break;
        case 'h':
            std::fputs(usage, stdout);
            return 0;
        case 'v':
            std::puts("ale-screen 0.1.0");
            return 0;
        default:
            return 2;
        }
    }
    if (optind < argc) {
        std::fprintf(stderr, "ale-screen: what is \"%s\"? (see --help)\n", argv[optind]);
        return 2;
    }
    return -1;
}

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

int print_once(console::LcmFeed &feed, text_screen::RobotState &state)
{
    const auto end = text_screen::RobotState::Clock::now() + once_waits;
    while (!(state.pose && state.status && state.map.num_lines > 0) &&
           text_screen::RobotState::Clock::now() < end && !interrupted) {
        listen(feed, state);
    }
    if (!state.pose) {
        std::fputs("ale-screen: no robot heard\n", stderr);
        return 1;
    }
    for (const auto &row :
         text_screen::picture(state, text_screen::RobotState::Clock::now(), {}, once_columns, once_rows)) {
        for (const auto &span : row.spans) {
            std::fputs(span.text.c_str(), stdout);
        }
        std::putchar('\n');
    }
    return 0;
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
    while (!interrupted && take_key(terminal.key(), look)) {
        terminal.show(text_screen::picture(state, text_screen::RobotState::Clock::now(), look,
                                           terminal.columns(), terminal.rows()));
        listen(feed, state);
    }
}

int run(const Options &options)
{
    console::LcmFeed feed(options.lcm_url);
    text_screen::RobotState state;
    state.subscribe(feed);
    if (options.once) {
        return print_once(feed, state);
    }
    watch(feed, state);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    const int answered = parse(argc, argv, options);
    if (answered >= 0) {
        return answered;
    }
    for (const int number : {SIGINT, SIGTERM}) {
        std::signal(number, [](int) { interrupted = true; });
    }
    try {
        return run(options);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-screen: %s\n", error.what());
        return 1;
    }
}
