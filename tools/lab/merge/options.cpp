#include "lab/merge/options.h"

#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"

namespace merge
{

namespace
{

constexpr char usage[] =
    "usage: ale-merge LOG... [options]\n"
    "Makes one map of several drives: of days, of robots.\n"
    "LOG: as for ale-replay.\n"
    "  --out F               the map, as ale-slamd and ale-replay --load-map load it\n"
    "  --map F               the same drawn: .svg, .png, .dxf, or .pgm with .yaml; may be repeated\n"
    "  --points              draw the points of the scans faintly behind the map (.svg, .png)\n"
    "  --trajectories FOLDER a file NAME.tum for each drive: its poses in the map\n"
    "  --frame robot|laser   whose poses they are (default robot)\n"
    "  --odometry on|off     use the odometry of the logs (default on)\n"
    "  --config FILE         configuration, as for ale-slamd\n"
    "  --help, --version\n"
    "Exit 0: all drives are in the map; 1: some are not, or it failed; 2: wrong use.\n";

void bind(cli::CommandLine &line, Options &o)
{
    line.text("out", o.out);
    cli::map_images(line, o.maps);
    line.flag("points", o.points);
    line.text("trajectories", o.trajectories);
    line.choice("frame", o.laser_frame, cli::Choices<bool>{{"robot", false}, {"laser", true}});
    line.choice("odometry", o.use_odometry, cli::Choices<bool>{{"on", true}, {"off", false}});
    line.text("config", o.config);
    line.arguments("LOG", o.drives);
}

void check(const Options &o)
{
    if (o.out == "-") {
        throw cli::WrongUse("a saved map is a file");
    }
    cli::Files files;
    for (const std::string &path : o.drives) {
        files.reads("LOG", path);
    }
    files.reads("--config", o.config);
    files.writes("--out", o.out);
    for (const std::string &path : o.maps) {
        files.writes("--map", path);
    }
}

} // namespace

int with_options(int argc, char **argv, const std::function<int(const Options &)> &work)
{
    Options options;
    cli::CommandLine line("ale-merge", usage);
    bind(line, options);
    return line.run(argc, argv, [&] {
        check(options);
        return work(options);
    });
}

} // namespace merge
