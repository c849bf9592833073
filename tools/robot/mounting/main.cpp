/* ale-mounting: where the scanner sits, how the wheels err and how late they are, from a recorded drive. */
#include <filesystem>
#include <stdexcept>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/files.h"
#include "common/export/text_file.h"
#include "robot/mounting/report.h"

namespace
{

constexpr char usage[] =
    "usage: ale-mounting LOG [--out FILE] [--config FILE]\n"
    "Finds the scanner's mounting, the systematic errors of the wheels and the lag between both from a "
    "recorded\n"
    "drive with scans and odometry, and writes them as configuration for ale-slamd. LOG: any format that "
    "ale-replay\n"
    "reads. Drive for a minute among walls: straight ways of a few metres, turns in both directions, also on "
    "the spot.\n"
    "  --out FILE     where the [sensor] and [odometry] sections go (default: standard output)\n"
    "  --config FILE  configuration, as for ale-slamd: noise of the scanner, blind sectors, upside down\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed, 2 wrong use.\n";

struct Options {
    std::string log;
    std::string out = "-";
    std::string config;
};

mounting::Fit fit_of(const Options &options)
{
    const mounting::Drive drive = mounting::read_drive(options.log, options.config);
    try {
        return mounting::fit(drive);
    } catch (const std::runtime_error &error) {
        throw std::runtime_error(options.log + ": " + error.what());
    }
}

void check_files(const Options &options)
{
    cli::Files files;
    files.reads("LOG", options.log);
    files.reads("--config", options.config);
    files.writes("--out", options.out);
}

void run(const Options &options)
{
    const mounting::Fit fit = fit_of(options);
    ale::TextFile file(options.out);
    file.put(mounting::configuration(fit, std::filesystem::path(options.log).filename().string()));
    file.close();
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-mounting", usage);
    line.argument("LOG", options.log);
    line.text("out", options.out);
    line.text("config", options.config);
    return line.run(argc, argv, [&] {
        check_files(options);
        run(options);
    });
}
