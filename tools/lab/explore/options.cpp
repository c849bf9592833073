#include "lab/explore/options.h"

#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"

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
    "  --map FILE      what the last run mapped: .png, .svg, .dxf, .pgm, .geojson\n"
    "  --help, --version\n"
    "One line a run on stdout. Exit: 0 when every run came back within 10 cm of its start, with 95 % of the "
    "area\n"
    "mapped that a disc of the robot's width can reach, without a collision; 1 when not; 2 wrong use.\n";

void bind(cli::CommandLine &line, Options &o)
{
    line.text("world", o.world);
    line.option("config", [&o](const std::string &path) { cli::load_config(path, o.config); });
    line.number("seed", o.first_seed, uint64_t{0}, uint64_t{4000000000});
    line.number("seeds", o.seeds, uint64_t{1}, uint64_t{10000});
    line.text("noise", o.source.noise);
    line.number("time", o.longest_s, 1.0, 100000.0);
    cli::map_image(line, o.map);
}

void complete(Options &o)
{
    if (o.world.empty()) {
        throw cli::WrongUse("--world WORLD is missing");
    }
    sim::noise_model(o.source.noise);
    cli::Files files;
    files.reads("--world", o.world);
    files.writes("--map", o.map);
    o.source.journey.slip = sim::driven_slip;
    o.source.journey.collision_radius = o.width() / 2;
}

} // namespace

int with_options(int argc, char **argv, const std::function<int(const Options &)> &work)
{
    Options options;
    cli::CommandLine line("ale-explore", usage);
    bind(line, options);
    return line.run(argc, argv, [&] {
        complete(options);
        return work(options);
    });
}

} // namespace explore
