/* ale-bridge: a selected, thinned set of channels over a unicast link. */
#include <cinttypes>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "common/feed/vouched.h"
#include "operator/bridge/bridge.h"

namespace
{

constexpr char usage[] =
    "usage: ale-bridge --listen [ADDR:]PORT --keys LIST [--own-key FILE] | --connect HOST:PORT --keys FILE "
    "[--robots FILE]\n"
    "                  [--send CHANNEL[:HZ]]... [--accept CHANNEL]... [--lcm-url URL]\n"
    "Carries LCM channels over a unicast UDP link, one end on the robot, the others with operators: for "
    "Wi-Fi, "
    "which\n"
    "loses multicast. Both ends prove who they are, and what they carry is encrypted.\n"
    "  --listen [ADDR:]PORT  the robot's end: waits for operators\n"
    "  --connect HOST:PORT   an operator's end\n"
    "  --keys FILE           robot: who is let in (robot.keys); operator: his secret key (alice.key)\n"
    "  --own-key FILE        robot: its own secret key (default: that of --keys with .secret behind)\n"
    "  --robots FILE         operator: the robots that he believes (default: that of --keys with .robots "
    "behind)\n"
    "  --send CHANNEL[:HZ]   goes over the link, HZ times a second at most; instead of what is sent by "
    "default\n"
    "  --accept CHANNEL      is taken from the link; instead of what is accepted by default\n"
    "  --lcm-url URL         LCM at this end (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --help, --version\n"
    "By default the robot's end sends ALE_POSE ALE_TRACKING ALE_STATUS ALE_SPEAKER ALE_VOUCHED ALE_MAP "
    "ALE_MAP_PIECES "
    "ALE_GRAPH ALE_PLAN ALE_FEATURES:5\n"
    "ALE_DRIVE:5 ALE_ODOMETRY:20 ALE_SCAN:2 POSE LASER:2\n"
    "and accepts ALE_COMMAND alone; the operator's end the other way round.\n"
    "Ends with Ctrl-C or SIGTERM and says what it has carried. Exit status: 0 fine, 1 failed, 2 wrong use.\n";

const std::vector<std::string> of_robot = {
    "ALE_POSE",    "ALE_TRACKING",    "ALE_STATUS", "ALE_SPEAKER",    "ALE_VOUCHED",
    "ALE_MAP",     "ALE_MAP_PIECES",  "ALE_GRAPH",  "ALE_FEATURES:5", "ALE_PLAN",
    "ALE_DRIVE:5", "ALE_ODOMETRY:20", "ALE_SCAN:2", "POSE",           "LASER:2"};
const std::vector<std::string> of_operator = {"ALE_COMMAND"};

struct Options {
    std::string listen;
    std::string connect;
    std::string keys;
    std::string own_key;
    std::string robots;
    std::vector<std::string> send;
    std::vector<std::string> accept;
    std::string lcm_url;
};

const std::vector<std::string> &either(const std::vector<std::string> &chosen,
                                       const std::vector<std::string> &usual)
{
    return chosen.empty() ? usual : chosen;
}

[[noreturn]] void fail(const char *error)
{
    throw std::runtime_error(error);
}

bridge::Ends robots_end(const Options &options)
{
    ale_keys_t operators;
    ale_secret_key_t own;
    char error[ALE_KEYS_ERROR];
    const std::string own_key = options.own_key.empty() ? options.keys + ALE_OWN_KEY_ENDING : options.own_key;
    if (ale_keys_load(options.keys.c_str(), &operators, error) < 0 ||
        ale_robot_key_load(own_key.c_str(), &own, error) < 0) {
        fail(error);
    }
    return bridge::Ends::of_robot(own, operators);
}

bridge::Ends operators_end(const Options &options)
{
    ale_secret_key_t own;
    char error[ALE_KEYS_ERROR];
    if (ale_secret_key_load(options.keys.c_str(), &own, error) < 0) {
        fail(error);
    }
    const ale_keys_t robots = feed::believed(options.robots, options.keys);
    if (robots.count == 0) {
        throw std::runtime_error(options.keys + ALE_ROBOTS_ENDING +
                                 ": no robot is believed (ale-keys --know, or --robots)");
    }
    return bridge::Ends::of_operator(own, robots, bridge::Address::of(options.connect));
}

void run(const Options &options)
{
    const bool robot = !options.listen.empty();
    if (robot != options.connect.empty()) {
        throw cli::WrongUse("one of --listen and --connect is wanted");
    }
    if (options.keys.empty()) {
        throw cli::WrongUse("--keys is missing: nobody is let in, or believed, without");
    }
    const bridge::Selection send(either(options.send, robot ? of_robot : of_operator));
    const bridge::Selection accept(either(options.accept, robot ? of_operator : of_robot));
    bridge::UdpSocket socket(robot ? options.listen : options.connect, robot);
    bridge::Bridge carrier(options.lcm_url, std::move(socket),
                           robot ? robots_end(options) : operators_end(options), send, accept);
    while (!cli::interrupted()) {
        carrier.step();
    }
    const bridge::Counts &counts = carrier.counts();
    std::printf("sent %" PRIu64 "\nthinned %" PRIu64 "\nunsent %" PRIu64 "\nreceived %" PRIu64
                "\nlost %" PRIu64 "\nlate %" PRIu64 "\nrefused %" PRIu64 "\n",
                counts.sent, counts.thinned, counts.unsent, counts.received, carrier.ends().lost(),
                carrier.ends().late(), counts.refused);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-bridge", usage);
    line.text("listen", options.listen);
    line.text("connect", options.connect);
    line.text("keys", options.keys);
    line.text("own-key", options.own_key);
    line.text("robots", options.robots);
    line.texts("send", options.send);
    line.texts("accept", options.accept);
    line.text("lcm-url", options.lcm_url);
    return line.run(argc, argv, [&] {
        cli::catch_interrupts();
        run(options);
    });
}
