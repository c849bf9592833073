#include "explore/options.h"

#include <charconv>
#include <cstdio>
#include <sstream>

#include <getopt.h>

#include "export/map_image.h"
#include "sim/units.h"
#include "sim/wrong_use.h"

namespace explore
{

namespace
{

const char usage[] =
    "usage: ale-explore --world WORLD [options]\n"
    "The robot explores a world of the simulator by itself, without lines and clocks: minutes pass in "
    "seconds.\n"
    "  --world WORLD   plan of walls as ale-sim takes it\n"
    "  --config FILE   the robot's configuration: [robot], [explore] and what the pose needs\n"
    "  --seed N        first run of noise, wheel errors and slip (default 1)\n"
    "  --seeds N       so many runs (default 1)\n"
    "  --noise NAME    real (default), white, none\n"
    "  --time S        longest exploration, seconds of the robot (default 1800)\n"
    "  --map FILE      what the last run mapped: .png, .svg, .dxf, .pgm\n"
    "  --help, --version\n"
    "One line a run on stdout. Exit: 0 when every run came back within 10 cm of its start, with 95 % of the "
    "area\n"
    "mapped that a disc of the robot's width can reach, without a collision; 1 when not; 2 wrong use.\n";

enum Choice { world_file = 256, config_file, seed, seeds, noise_name, longest, map_file, help, version };

const option known[] = {
    {"world", required_argument, nullptr, world_file}, {"config", required_argument, nullptr, config_file},
    {"seed", required_argument, nullptr, seed},        {"seeds", required_argument, nullptr, seeds},
    {"noise", required_argument, nullptr, noise_name}, {"time", required_argument, nullptr, longest},
    {"map", required_argument, nullptr, map_file},     {"help", no_argument, nullptr, help},
    {"version", no_argument, nullptr, version},        {nullptr, 0, nullptr, 0}};

uint64_t whole_number(const std::string &option, const std::string &text, uint64_t low, uint64_t high)
{
    uint64_t value = 0;
    const char *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value < low || value > high) {
        std::ostringstream message;
        message << "--" << option << " " << text << ": expected a whole number from " << low << " to "
                << high;
        throw sim::WrongUse(message.str());
    }
    return value;
}

void load_config(const char *path, ale_config_t &config)
{
    ale_config_error_t error;
    if (ale_config_load(path, &config, &error) < 0) {
        throw sim::WrongUse(error.message);
    }
}

void take_option(int choice, const char *text, Options &o)
{
    switch (choice) {
    case world_file:
        o.world = text;
        break;
    case config_file:
        load_config(text, o.config);
        break;
    case seed:
        o.first_seed = whole_number("seed", text, 0, 4000000000);
        break;
    case seeds:
        o.seeds = whole_number("seeds", text, 1, 10000);
        break;
    case noise_name:
        o.source.noise = text;
        break;
    case longest:
        o.longest_s = static_cast<double>(whole_number("time", text, 1, 100000));
        break;
    default:
        o.map = text;
        break;
    }
}

void check(const Options &o)
{
    if (o.world.empty()) {
        throw sim::WrongUse("--world WORLD is missing");
    }
    if (!o.map.empty() && !ale::is_map_image_name(o.map)) {
        throw sim::WrongUse("--map " + o.map + ": there are .png, .svg, .dxf, .pgm");
    }
    sim::noise_model(o.source.noise);
}

} // namespace

int parse_options(int argc, char **argv, Options &options)
{
    for (int choice; (choice = getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        switch (choice) {
        case help:
            std::fputs(usage, stdout);
            return 0;
        case version:
            std::puts("ale-explore 0.1.0");
            return 0;
        case '?':
            return 2;
        default:
            take_option(choice, optarg, options);
            break;
        }
    }
    if (optind < argc) {
        throw sim::WrongUse(std::string("what is \"") + argv[optind] + "\"?");
    }
    check(options);
    options.source.journey.slip = sim::driven_slip;
    options.source.journey.collision_radius = options.width() / 2;
    return -1;
}

} // namespace explore
