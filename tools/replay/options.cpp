#include "replay/options.h"

#include <array>
#include <cstdio>
#include <getopt.h>

#include "export/map_image.h"

extern "C" {
#include "base/trig.h"
#include "decimal.h"
}

namespace ale
{

namespace
{

constexpr char usage[] =
    "usage: ale-replay LOG [options]\n"
    "Runs a recorded log through the code of the firmware, as fast as it goes.\n"
    "LOG: CARMEN, rover, .scan or Odometry/Laser text, .scip recording, LCM event log; plain or gzip.\n"
    "  --features F.jsonl      lines, corners and curves of every scan\n"
    "  --poses F.jsonl         both poses, covariance and state at every scan\n"
    "  --trajectory F.tum      map pose at every scan, with all corrections\n"
    "  --trajectory-live F.tum map pose at every scan, as known at that moment\n"
    "  --frame robot|laser     whose poses the trajectories hold (default robot)\n"
    "  --map F                 the map at the end: .svg, .png, .dxf, or .pgm with .yaml; may be repeated\n"
    "  --points                draw the points of the scans faintly behind the map (.svg, .png)\n"
    "  --timing F.csv          thread CPU time of every stage of every scan\n"
    "  --odometry on|off       use the odometry of the log (default on)\n"
    "  --loops on|off          close loops (default on)\n"
    "  --sensor X,Y,THETA      where the laser sits on the robot, metres and radians (default: what "
    "--config\n"
    "                          says, else what the log says)\n"
    "  --config FILE           configuration, as for ale-slamd\n"
    "  --load-map F            start with this map, the robot's place in it unknown\n"
    "  --save-map F            write the map at the end\n"
    "  --lines-only            extract only: no poses, no map\n"
    "  --help, --version\n"
    "F may be - for the standard output. Exit 0 fine, 1 failed, 2 wrong use.\n";

enum Option {
    CONFIG = 1,
    FEATURES,
    POSES,
    TRAJECTORY,
    TRAJECTORY_LIVE,
    FRAME,
    MAP,
    POINTS,
    TIMING,
    ODOMETRY,
    LOOPS,
    SENSOR,
    LOAD_MAP,
    SAVE_MAP,
    LINES_ONLY,
    HELP,
    VERSION
};

const option known_options[] = {{"config", required_argument, nullptr, CONFIG},
                                {"features", required_argument, nullptr, FEATURES},
                                {"poses", required_argument, nullptr, POSES},
                                {"trajectory", required_argument, nullptr, TRAJECTORY},
                                {"trajectory-live", required_argument, nullptr, TRAJECTORY_LIVE},
                                {"frame", required_argument, nullptr, FRAME},
                                {"map", required_argument, nullptr, MAP},
                                {"points", no_argument, nullptr, POINTS},
                                {"timing", required_argument, nullptr, TIMING},
                                {"odometry", required_argument, nullptr, ODOMETRY},
                                {"loops", required_argument, nullptr, LOOPS},
                                {"sensor", required_argument, nullptr, SENSOR},
                                {"load-map", required_argument, nullptr, LOAD_MAP},
                                {"save-map", required_argument, nullptr, SAVE_MAP},
                                {"lines-only", no_argument, nullptr, LINES_ONLY},
                                {"help", no_argument, nullptr, HELP},
                                {"version", no_argument, nullptr, VERSION},
                                {nullptr, 0, nullptr, 0}};

int wrong_use(const std::string &what)
{
    std::fprintf(stderr, "ale-replay: %s (see --help)\n", what.c_str());
    return 2;
}

/* "X,Y,THETA" in metres and radians. */
std::optional<ale_pose_t> parse_pose(const std::string &text)
{
    std::array<int64_t, 3> number{};
    size_t at = 0;
    for (size_t i = 0; i < 3; i++) {
        const size_t comma = i < 2 ? text.find(',', at) : text.size();
        if (comma == std::string::npos ||
            ale_decimal_parse(text.substr(at, comma - at).c_str(), i < 2 ? 6 : 9, &number[i]) < 0) {
            return std::nullopt;
        }
        at = comma + 1;
    }
    constexpr int64_t most_um = 100000000;
    constexpr int64_t most_nrad = 3141592654;
    if (std::abs(number[0]) > most_um || std::abs(number[1]) > most_um || std::abs(number[2]) > most_nrad) {
        return std::nullopt;
    }
    return ale_pose_t{static_cast<int32_t>(number[0]), static_cast<int32_t>(number[1]),
                      static_cast<uint32_t>(ale_nrad_to_bam(number[2]))};
}

/* One of two words; *second tells which. */
bool parse_choice(const std::string &text, const char *first_word, const char *second_word, bool &second)
{
    second = text == second_word;
    return second || text == first_word;
}

int take_file_option(int choice, ReplayOptions &options)
{
    std::string *const file = choice == CONFIG            ? &options.config
                              : choice == FEATURES        ? &options.features
                              : choice == POSES           ? &options.poses
                              : choice == TRAJECTORY      ? &options.trajectory
                              : choice == TRAJECTORY_LIVE ? &options.trajectory_live
                              : choice == TIMING          ? &options.timing
                              : choice == LOAD_MAP        ? &options.load_map
                                                          : &options.save_map;
    *file = optarg;
    return file->empty() ? wrong_use("empty file name") : -1;
}

int take_map(ReplayOptions &options)
{
    if (!is_map_image_name(optarg)) {
        return wrong_use(std::string("--map ") + optarg + ": the name must end in .svg, .png, .pgm or .dxf");
    }
    options.maps.emplace_back(optarg);
    return -1;
}

int take_option(int choice, ReplayOptions &options)
{
    switch (choice) {
    case FRAME:
        return parse_choice(optarg, "robot", "laser", options.laser_frame)
                   ? -1
                   : wrong_use("--frame is robot or laser");
    case ODOMETRY:
        return parse_choice(optarg, "off", "on", options.use_odometry) ? -1
                                                                       : wrong_use("--odometry is on or off");
    case LOOPS:
        return parse_choice(optarg, "off", "on", options.close_loops) ? -1
                                                                      : wrong_use("--loops is on or off");
    case SENSOR:
        options.sensor = parse_pose(optarg);
        return options.sensor ? -1 : wrong_use("--sensor is X,Y,THETA: at most 100 m and half a turn");
    case MAP:
        return take_map(options);
    case POINTS:
        options.points = true;
        return -1;
    case LINES_ONLY:
        options.lines_only = true;
        return -1;
    case HELP:
        std::fputs(usage, stdout);
        return 0;
    case VERSION:
        std::puts("ale-replay 0.1.0");
        return 0;
    case '?':
        return 2;
    default:
        return take_file_option(choice, options);
    }
}

int check(const ReplayOptions &options)
{
    const bool needs_poses = !options.poses.empty() || !options.trajectory.empty() ||
                             !options.trajectory_live.empty() || !options.maps.empty() ||
                             !options.load_map.empty() || !options.save_map.empty();
    if (options.lines_only && needs_poses) {
        return wrong_use("--lines-only makes neither poses nor a map");
    }
    return -1;
}

} // namespace

int parse_options(int argc, char **argv, ReplayOptions &options)
{
    for (int choice; (choice = getopt_long(argc, argv, "", known_options, nullptr)) != -1;) {
        const int code = take_option(choice, options);
        if (code >= 0) {
            return code;
        }
    }
    if (optind >= argc) {
        return wrong_use("which log?");
    }
    if (optind + 1 < argc) {
        return wrong_use(std::string("one log at a time; what is \"") + argv[optind + 1] + "\"?");
    }
    options.log = argv[optind];
    return check(options);
}

} // namespace ale
