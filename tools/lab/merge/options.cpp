#include "lab/merge/options.h"

#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"

namespace merge
{

namespace
{

constexpr char usage[] =
    "usage: ale-merge LOG... [options]\n"
    "       ale-merge LOG... --drives FILE\n"
    "       ale-merge --into FILE LOG... [options]\n"
    "       ale-merge --versions FILE\n"
    "Makes one map of several drives: of days, of robots; or keeps a building's map, which every drive makes "
    "better.\n"
    "LOG: as for ale-replay, or a FILE of --drives.\n"
    "  --drives FILE         no map, but the drives and which of them join: another merge goes on from "
    "there\n"
    "                        without their logs\n"
    "  --into FILE           the map that is kept; what it is made of is in the folder FILE.d: logs of "
    "drives,\n"
    "                        and of every version the map and a picture (new walls green, moved amber, gone "
    "red)\n"
    "  --keep N              drives whose logs are kept there, the latest (default 20, 1 to 1000); of others "
    "the walls\n"
    "  --versions            lists the versions of a kept map\n"
    "  --out F               the map, as ale-slamd and ale-replay --load-map load it\n"
    "  --tiles F             the same by tiles, of a building of any size: the robot loads those around it\n"
    "  --tile-side M         their side, whole metres (default 10, 1 to 1000)\n"
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
    line.text("drives", o.keep_drives);
    line.text("out", o.out);
    line.text("tiles", o.tiles);
    line.option("tile-side", [&o](const std::string &word) {
        o.tile_side_um = 1000000 * cli::number_of<int32_t>("--tile-side", word, 1, 1000);
    });
    line.text("into", o.into);
    line.number<size_t>("keep", o.keep, 1, 1000);
    line.flag("versions", o.versions);
    cli::map_images(line, o.maps);
    line.flag("points", o.points);
    line.text("trajectories", o.trajectories);
    line.choice("frame", o.laser_frame, cli::Choices<bool>{{"robot", false}, {"laser", true}});
    line.choice("odometry", o.use_odometry, cli::Choices<bool>{{"on", true}, {"off", false}});
    line.text("config", o.config);
    line.arguments("LOG", o.drives);
}

void check_maps(const Options &o)
{
    if (o.out == "-" || o.into == "-" || o.tiles == "-" || o.keep_drives == "-") {
        throw cli::WrongUse("what is saved is a file");
    }
    if (!o.into.empty() && !o.out.empty()) {
        throw cli::WrongUse("--out and --into: the map is in one of them");
    }
    const bool writes = !o.into.empty() || !o.out.empty() || !o.tiles.empty();
    if (o.versions && (o.drives.size() != 1 || writes)) {
        throw cli::WrongUse("--versions: one kept map, and nothing else");
    }
}

void check_drives(const Options &o)
{
    const bool writes = !(o.into + o.out + o.tiles + o.trajectories).empty() || !o.maps.empty();
    if (!o.keep_drives.empty() && (writes || o.versions)) {
        throw cli::WrongUse("--drives: nothing else is written with it");
    }
}

void check_files(const Options &o)
{
    cli::Files files;
    for (const std::string &path : o.drives) {
        files.reads("LOG", path);
    }
    files.reads("--config", o.config);
    files.writes("--drives", o.keep_drives);
    files.writes("--out", o.out);
    files.writes("--tiles", o.tiles);
    files.writes("--into", o.into);
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
        check_maps(options);
        check_drives(options);
        check_files(options);
        return work(options);
    });
}

} // namespace merge
