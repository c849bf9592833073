#include "sim/options.h"

#include <charconv>
#include <cstdio>
#include <sstream>
#include <vector>

#include <getopt.h>

#include "sim/wrong_use.h"

namespace sim
{

const char usage[] =
    "usage: ale-sim (--log LOG | --world WORLD) --pty LINK [options]\n"
    "       ale-sim --world WORLD --write-log FILE [--truth FILE]\n"
    "       ale-sim (--log LOG | --world WORLD) --describe\n"
    "A URG-04LX on a pseudo terminal, seeing a recorded log or a simulated world. It plays from the moment "
    "a\n"
    "client first asks for ranges.\n"
    "  --log LOG            play a recording (any format that ale-replay reads)\n"
    "  --world WORLD        drive through a plan of walls: x1 y1 x2 y2, # start x y theta, # via x y\n"
    "  --pty LINK           symbolic link to the pseudo terminal; removed at the end\n"
    "  --protocol P         scip2 (default); scip1: powers up in 1.1, can be switched; scip1-only\n"
    "  --speed X            time runs X times as fast (default 1); ale-slamd wants the same --time-scale\n"
    "  --baud-limit N       the line carries N bytes a second (default: no limit)\n"
    "  --command-interval MS  commands are served at most so often (real firmware: 100; default 0)\n"
    "  --once               end when the log or the way is over; else the robot stands and the scans go on\n"
    "  --seed N             another run of noise and wheel errors (default 1)\n"
    "  --faults SPEC        e.g. flip@5,garbage:300@8,silence:2@12,unplug:2@#200: NAME[:ARGUMENT]@SECONDS "
    "or\n"
    "                       @#SCAN; flip cut garbage:N repeat silence:S unplug:S reset11 hardware:NN wrap\n"
    "  --lcm-url URL        where ALE_ODOMETRY goes (default: LCM_DEFAULT_URL, else LCM's own)\n"
    "  --no-odometry        send none\n"
    "  --truth FILE         the robot's true pose at the stamp of every scan sent (TUM); worlds only\n"
    "  --describe           print what is known of mounting and odometry as configuration of ale-slamd\n"
    "For worlds:\n"
    "  --drive              obey ALE_DRIVE (inertia, slip, collisions) instead of following the way\n"
    "  --noise NAME         real (default), white, none\n"
    "  --sensor X,Y,THETA   mounting of the laser, metres and radians (default: as the world says)\n"
    "  --odometry-lag S     odometry is so much younger than its stamp says (default 0)\n"
    "  --max-speed V        m/s (default 0.5)\n"
    "  --max-turn W         rad/s (default 0.9)\n"
    "  --write-log FILE     write the drive as a CARMEN log instead of playing it\n"
    "  --help, --version\n"
    "At the end, on stdout: scans, sent, damaged, swallowed (and collisions), one a line.\n"
    "Exit: 0 fine, 1 failed, 2 wrong use.\n";

namespace
{

double number(const std::string &option, const std::string &text, double low, double high)
{
    double value = 0;
    const char *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !(value >= low && value <= high)) {
        std::ostringstream message;
        message << "--" << option << " " << text << ": expected a number from " << low << " to " << high;
        throw WrongUse(message.str());
    }
    return value;
}

Pose mounting(const std::string &text)
{
    std::istringstream parts(text);
    std::vector<double> v;
    for (std::string part; std::getline(parts, part, ',');) {
        v.push_back(number("sensor", part, -10, 10));
    }
    if (v.size() != 3) {
        throw WrongUse("--sensor " + text + ": expected X,Y,THETA");
    }
    return {v[0], v[1], v[2]};
}

Protocol protocol(const std::string &text)
{
    if (text == "scip1") {
        return Protocol::scip1;
    }
    if (text == "scip1-only") {
        return Protocol::scip1_only;
    }
    if (text == "scip2") {
        return Protocol::scip2;
    }
    throw WrongUse("--protocol " + text + ": there are scip1, scip1-only, scip2");
}

void require(bool condition, const char *message)
{
    if (!condition) {
        throw WrongUse(message);
    }
}

void check(const Options &o)
{
    const bool play = o.write_log.empty() && !o.describe;
    require(o.log.empty() != o.world.empty(), "give either --log LOG or --world WORLD");
    require(!play || !o.simulator.link.empty(), "--pty LINK is missing");
    require(o.truth.empty() || !o.world.empty(),
            "--truth: nobody knows the truth of a log, only of a --world");
    require(o.write_log.empty() || !o.world.empty(), "--write-log needs a --world");
    require(!o.drive || !o.world.empty(), "--drive needs a --world: a log cannot be steered");
    require(!o.drive || play, "--drive needs somebody who drives: not with --write-log or --describe");
    parse_faults(o.simulator.faults);
    noise_model(o.world_source.noise);
    require(!o.drive || o.world_source.odometry_lag_us == 0, "--drive and --odometry-lag do not go together");
}

enum Choice {
    log_file = 256,
    world_file,
    link_path,
    protocol_name,
    speed,
    baud_limit,
    command_interval,
    once,
    seed,
    faults,
    lcm_url,
    no_odometry,
    truth_file,
    describe,
    drive,
    noise_name,
    sensor,
    odometry_lag,
    max_speed,
    max_turn,
    log_out,
    help,
    version
};

const option known[] = {{"log", required_argument, nullptr, log_file},
                        {"world", required_argument, nullptr, world_file},
                        {"pty", required_argument, nullptr, link_path},
                        {"protocol", required_argument, nullptr, protocol_name},
                        {"speed", required_argument, nullptr, speed},
                        {"baud-limit", required_argument, nullptr, baud_limit},
                        {"command-interval", required_argument, nullptr, command_interval},
                        {"once", no_argument, nullptr, once},
                        {"seed", required_argument, nullptr, seed},
                        {"faults", required_argument, nullptr, faults},
                        {"lcm-url", required_argument, nullptr, lcm_url},
                        {"no-odometry", no_argument, nullptr, no_odometry},
                        {"truth", required_argument, nullptr, truth_file},
                        {"describe", no_argument, nullptr, describe},
                        {"drive", no_argument, nullptr, drive},
                        {"noise", required_argument, nullptr, noise_name},
                        {"sensor", required_argument, nullptr, sensor},
                        {"odometry-lag", required_argument, nullptr, odometry_lag},
                        {"max-speed", required_argument, nullptr, max_speed},
                        {"max-turn", required_argument, nullptr, max_turn},
                        {"write-log", required_argument, nullptr, log_out},
                        {"help", no_argument, nullptr, help},
                        {"version", no_argument, nullptr, version},
                        {nullptr, 0, nullptr, 0}};

void take_world_option(int choice, const char *text, Options &o)
{
    RobotLimits &limits = o.world_source.journey.limits;
    switch (choice) {
    case drive:
        o.drive = true;
        break;
    case noise_name:
        o.world_source.noise = text;
        break;
    case sensor:
        o.sensor = mounting(text);
        break;
    case odometry_lag:
        o.world_source.odometry_lag_us = std::llround(number("odometry-lag", text, 0, 1) * 1e6);
        break;
    case max_speed:
        limits.speed = number("max-speed", text, 0.01, 5);
        break;
    case max_turn:
        limits.turn_rate = number("max-turn", text, 0.01, 10);
        break;
    default:
        o.write_log = text;
        break;
    }
}

void take_option(int choice, const char *text, Options &o)
{
    switch (choice) {
    case log_file:
        o.log = text;
        break;
    case world_file:
        o.world = text;
        break;
    case link_path:
        o.simulator.link = text;
        break;
    case protocol_name:
        o.simulator.protocol = protocol(text);
        break;
    case speed:
        o.simulator.speed = number("speed", text, 0.01, 1000);
        break;
    case baud_limit:
        o.simulator.baud_limit = std::llround(number("baud-limit", text, 100, 1e9));
        break;
    case command_interval:
        o.simulator.command_interval_us = std::llround(number("command-interval", text, 0, 10000) * 1000);
        break;
    case once:
        o.once = true;
        break;
    case seed:
        o.simulator.seed = static_cast<uint64_t>(number("seed", text, 0, 4e9));
        break;
    case faults:
        o.simulator.faults = text;
        break;
    case lcm_url:
        o.lcm_url = text;
        break;
    case no_odometry:
        o.odometry = false;
        break;
    case truth_file:
        o.truth = text;
        break;
    case describe:
        o.describe = true;
        break;
    default:
        take_world_option(choice, text, o);
        break;
    }
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
            std::puts("ale-sim 0.1.0");
            return 0;
        case '?':
            return 2;
        default:
            take_option(choice, optarg, options);
            break;
        }
    }
    if (optind < argc) {
        throw WrongUse(std::string("what is \"") + argv[optind] + "\"?");
    }
    check(options);
    options.world_source.once = options.once || !options.write_log.empty();
    options.world_source.journey.seed = options.simulator.seed;
    return -1;
}

} // namespace sim
