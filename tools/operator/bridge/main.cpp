/* ale-bridge: a selected, thinned set of channels over a unicast link. */
#include <cinttypes>
#include <cstdio>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/interrupt.h"
#include "operator/bridge/bridge.h"

namespace
{

constexpr char usage[] =
    "usage: ale-bridge --listen [ADDR:]PORT | --connect HOST:PORT [--send CHANNEL[:HZ]]... [--accept "
    "CHANNEL]...\n"
    "                  [--lcm-url URL]\n"
    "Carries LCM channels over a unicast UDP link, one end on the robot, one with the operator: for Wi-Fi, "
    "which\n"
    "loses multicast.\n"
    "  --listen [ADDR:]PORT  the robot's end: waits for the other one\n"
    "  --connect HOST:PORT   the operator's end\n"
    "  --send CHANNEL[:HZ]   goes over the link, HZ times a second at most; instead of what is sent by "
    "default\n"
    "  --accept CHANNEL      is taken from the link; instead of what is accepted by default\n"
    "  --lcm-url URL         LCM at this end (default: LCM_DEFAULT_URL, else LCM's own default)\n"
    "  --help, --version\n"
    "By default the robot's end sends ALE_POSE ALE_TRACKING ALE_STATUS ALE_MAP ALE_MAP_PIECES ALE_FEATURES:5 "
    "ALE_DRIVE:5\n"
    "ALE_SCAN:2 POSE LASER:2\n"
    "and accepts ALE_COMMAND alone; the operator's end the other way round.\n"
    "Ends with Ctrl-C or SIGTERM and says what it has carried. Exit status: 0 fine, 1 failed, 2 wrong use.\n";

const std::vector<std::string> of_robot = {"ALE_POSE",       "ALE_TRACKING",   "ALE_STATUS",  "ALE_MAP",
                                           "ALE_MAP_PIECES", "ALE_FEATURES:5", "ALE_DRIVE:5", "ALE_SCAN:2",
                                           "POSE",           "LASER:2"};
const std::vector<std::string> of_operator = {"ALE_COMMAND"};

struct Options {
    std::string listen;
    std::string connect;
    std::vector<std::string> send;
    std::vector<std::string> accept;
    std::string lcm_url;
};

const std::vector<std::string> &either(const std::vector<std::string> &chosen,
                                       const std::vector<std::string> &usual)
{
    return chosen.empty() ? usual : chosen;
}

void run(const Options &options)
{
    const bool robot = !options.listen.empty();
    if (robot != options.connect.empty()) {
        throw cli::WrongUse("one of --listen and --connect is wanted");
    }
    const bridge::Selection send(either(options.send, robot ? of_robot : of_operator));
    const bridge::Selection accept(either(options.accept, robot ? of_operator : of_robot));
    bridge::Bridge carrier(options.lcm_url,
                           robot ? bridge::UdpLink::listening(options.listen)
                                 : bridge::UdpLink::connected(options.connect),
                           send, accept);
    while (!cli::interrupted()) {
        carrier.step();
    }
    const bridge::Counts &counts = carrier.counts();
    std::printf("sent %" PRIu64 "\nthinned %" PRIu64 "\nunsent %" PRIu64 "\nreceived %" PRIu64
                "\nlost %" PRIu64 "\nlate %" PRIu64 "\nrefused %" PRIu64 "\n",
                counts.sent, counts.thinned, counts.unsent, counts.received, carrier.arrivals().lost(),
                carrier.arrivals().late(), counts.refused);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-bridge", usage);
    line.text("listen", options.listen);
    line.text("connect", options.connect);
    line.texts("send", options.send);
    line.texts("accept", options.accept);
    line.text("lcm-url", options.lcm_url);
    return line.run(argc, argv, [&] {
        cli::catch_interrupts();
        run(options);
    });
}
