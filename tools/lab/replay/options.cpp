#include "lab/replay/options.h"

#include <algorithm>
#include <cmath>

#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"

extern "C" {
#include "base/trig.h"
}

namespace ale
{

namespace
{

constexpr char usage[] =
    "usage: ale-replay LOG [options]\n"
    "Runs a recorded log through the code of the firmware, as fast as it goes.\n"
    "LOG: CARMEN, rover, .scan or Odometry/Laser text, .scip recording, LCM event log; plain, gzip or "
    "bzip2.\n"
    "     A bag of ROS 1 or ROS 2, or MCAP, with LaserScan and Odometry, by ale-foxglove (PyPI's rosbags, "
    "mcap).\n"
    "  --features F.jsonl      lines, corners and curves of every scan\n"
    "  --poses F.jsonl         both poses, covariance and state at every scan\n"
    "  --trajectory F.tum      map pose at every scan, with all corrections\n"
    "  --trajectory-live F.tum map pose at every scan, as known at that moment\n"
    "  --frame robot|laser     whose poses the trajectories hold (default robot)\n"
    "  --map F                 the map at the end: .svg, .png, .dxf, .geojson, .pgm with .yaml; may be "
    "repeated\n"
    "  --map-resolution M      side of a cell of a .pgm, metres (default 0.05)\n"
    "  --points                draw the points of the scans faintly behind the map (.svg, .png)\n"
    "  --lcm F                 what the robot would send over LCM, as an event log\n"
    "  --timing F.csv          thread CPU time of every stage of every scan\n"
    "  --odometry on|off       use the odometry of the log (default on)\n"
    "  --loops on|off          close loops (default on)\n"
    "  --sensor X,Y,THETA      where the laser sits on the robot, metres and radians (default: what "
    "--config\n"
    "                          says, else what the log says)\n"
    "  --config FILE           configuration, as for ale-slamd\n"
    "  --model NAME            preset of the scanner's noise, as [sensor] model (ld06, utm-30lx, ...); "
    "default: what\n"
    "                          --config or the recording says, else by the log's kind\n"
    "  --load-map F            start with this map, or one of tiles\n"
    "  --start X,Y,THETA       where the robot is in it, within 0.4 m (default: unknown; it is then lost "
    "until found)\n"
    "  --save-map F            write the map at the end\n"
    "  --lines-only            extract only: no poses, no map\n"
    "  --help, --version\n"
    "F.jsonl, F.tum and F.csv may be - for the standard output. Exit 0 fine, 1 failed, 2 wrong use.\n";

constexpr double farthest_m = 1073; // of a map

ale_pose_t pose_of(const cli::Mounting &at)
{
    return {static_cast<int32_t>(std::lround(at.x_m * 1e6)), static_cast<int32_t>(std::lround(at.y_m * 1e6)),
            static_cast<uint32_t>(ale_nrad_to_bam(std::llround(at.theta_rad * 1e9)))};
}

void bind_results(cli::CommandLine &line, ReplayOptions &o)
{
    line.text("features", o.features);
    line.text("poses", o.poses);
    line.text("trajectory", o.trajectory);
    line.text("trajectory-live", o.trajectory_live);
    line.choice("frame", o.laser_frame, cli::Choices<bool>{{"robot", false}, {"laser", true}});
    cli::map_images(line, o.maps);
    line.option("map-resolution", [&o](const std::string &word) {
        o.map_cell_um = static_cast<int32_t>(
            std::lround(1e6 * cli::number_of<double>("--map-resolution", word, 0.001, 1)));
    });
    line.flag("points", o.points);
    line.text("timing", o.timing);
    line.text("lcm", o.lcm);
    line.text("save-map", o.save_map);
}

void bind(cli::CommandLine &line, ReplayOptions &o)
{
    const cli::Choices<bool> on_off = {{"on", true}, {"off", false}};
    line.argument("LOG", o.log);
    bind_results(line, o);
    line.choice("odometry", o.use_odometry, on_off);
    line.choice("loops", o.close_loops, on_off);
    line.option("sensor",
                [&o](const std::string &word) { o.sensor = pose_of(cli::mounting_of("--sensor", word)); });
    line.text("config", o.config);
    cli::scanner_model(line, "model", o.model);
    line.text("load-map", o.load_map);
    line.option("start", [&o](const std::string &word) {
        o.start = pose_of(cli::mounting_of("--start", word, farthest_m));
    });
    line.flag("lines-only", o.lines_only);
}

void check_files(const ReplayOptions &options)
{
    cli::Files files;
    files.reads("LOG", options.log);
    files.reads("--config", options.config);
    files.writes("--save-map", options.save_map); // may take the place of the one that was loaded
    files.reads("--load-map", options.load_map);
    files.writes("--features", options.features);
    files.writes("--poses", options.poses);
    files.writes("--trajectory", options.trajectory);
    files.writes("--trajectory-live", options.trajectory_live);
    files.writes("--timing", options.timing);
    files.writes("--lcm", options.lcm);
    for (const std::string &path : options.maps) {
        files.writes("--map", path);
    }
}

bool draws_grid(const ReplayOptions &options)
{
    return std::any_of(options.maps.begin(), options.maps.end(), [](const std::string &path) {
        return path.size() > 4 && path.compare(path.size() - 4, 4, ".pgm") == 0;
    });
}

bool needs_poses(const ReplayOptions &options)
{
    return !options.poses.empty() || !options.trajectory.empty() || !options.trajectory_live.empty() ||
           !options.maps.empty() || !options.load_map.empty() || !options.save_map.empty() ||
           !options.lcm.empty();
}

void check(const ReplayOptions &options)
{
    if (options.lines_only && needs_poses(options)) {
        throw cli::WrongUse("--lines-only makes neither poses nor a map");
    }
    if (options.points && options.maps.empty()) {
        throw cli::WrongUse("--points are drawn behind a --map");
    }
    if (options.map_cell_um != ScanCloud::usual_cell_um && !draws_grid(options)) {
        throw cli::WrongUse("--map-resolution is of a --map F.pgm");
    }
    if (options.start && options.load_map.empty()) {
        throw cli::WrongUse("--start is a place in the map of --load-map");
    }
    if (options.save_map == "-" || options.load_map == "-" || options.lcm == "-") {
        throw cli::WrongUse("a saved map and an LCM log are files");
    }
    check_files(options);
}

} // namespace

int with_options(int argc, char **argv, const std::function<int(const ReplayOptions &)> &work)
{
    ReplayOptions options;
    cli::CommandLine line("ale-replay", usage);
    bind(line, options);
    return line.run(argc, argv, [&] {
        check(options);
        return work(options);
    });
}

} // namespace ale
