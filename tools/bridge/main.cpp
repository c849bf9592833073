/* ale-bridge: a selected, thinned set of channels over a unicast link. */
#include <atomic>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <getopt.h>

#include "bridge/bridge.h"

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
    "By default the robot's end sends ALE_POSE ALE_STATUS ALE_MAP ALE_FEATURES:5 ALE_DRIVE:5 ALE_SCAN:2 POSE "
    "LASER:2\n"
    "and accepts ALE_COMMAND alone; the operator's end the other way round.\n"
    "Ends with Ctrl-C or SIGTERM and says what it has carried. Exit status: 0 fine, 1 failed, 2 wrong use.\n";

const std::vector<std::string> of_robot = {"ALE_POSE",    "ALE_STATUS", "ALE_MAP", "ALE_FEATURES:5",
                                           "ALE_DRIVE:5", "ALE_SCAN:2", "POSE",    "LASER:2"};
const std::vector<std::string> of_operator = {"ALE_COMMAND"};

struct Options {
    std::string listen;
    std::string connect;
    std::vector<std::string> send;
    std::vector<std::string> accept;
    std::string lcm_url;
};

std::atomic<bool> interrupted{false};

/* The exit code when the command line has been answered already, else -1. */
int parse(int argc, char **argv, Options &options)
{
    static const option known[] = {
        {"listen", required_argument, nullptr, 'i'},  {"connect", required_argument, nullptr, 'c'},
        {"send", required_argument, nullptr, 's'},    {"accept", required_argument, nullptr, 'a'},
        {"lcm-url", required_argument, nullptr, 'l'}, {"help", no_argument, nullptr, 'h'},
        {"version", no_argument, nullptr, 'v'},       {nullptr, 0, nullptr, 0}};
    for (int choice; (choice = getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        switch (choice) {
        case 'i':
            options.listen = optarg;
            break;
        case 'c':
            options.connect = optarg;
            break;
        case 's':
            options.send.emplace_back(optarg);
            break;
        case 'a':
            options.accept.emplace_back(optarg);
            break;
        case 'l':
            options.lcm_url = optarg;
            break;
        case 'h':
            std::fputs(usage, stdout);
            return 0;
        case 'v':
            std::puts("ale-bridge 0.1.0");
            return 0;
        default:
            return 2;
        }
    }
    if (optind < argc) {
        throw std::invalid_argument("what is \"" + std::string(argv[optind]) + "\"? (see --help)");
    }
    if (options.listen.empty() == options.connect.empty()) {
        throw std::invalid_argument("one of --listen and --connect is wanted (see --help)");
    }
    return -1;
}

const std::vector<std::string> &either(const std::vector<std::string> &chosen,
                                       const std::vector<std::string> &usual)
{
    return chosen.empty() ? usual : chosen;
}

void run(const Options &options)
{
    const bool robot = !options.listen.empty();
    const bridge::Selection send(either(options.send, robot ? of_robot : of_operator));
    const bridge::Selection accept(either(options.accept, robot ? of_operator : of_robot));
    bridge::Bridge carrier(options.lcm_url,
                           robot ? bridge::UdpLink::listening(options.listen)
                                 : bridge::UdpLink::connected(options.connect),
                           send, accept);
    while (!interrupted) {
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
    try {
        Options options;
        const int answered = parse(argc, argv, options);
        if (answered >= 0) {
            return answered;
        }
        for (const int number : {SIGINT, SIGTERM}) {
            std::signal(number, [](int) { interrupted = true; });
        }
        run(options);
        return 0;
    } catch (const std::invalid_argument &error) {
        std::fprintf(stderr, "ale-bridge: %s\n", error.what());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-bridge: %s\n", error.what());
        return 1;
    }
}
