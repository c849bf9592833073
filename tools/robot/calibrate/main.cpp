/* ale-calibrate: fits the noise model to a recording of a scanner at rest. */
#include <filesystem>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"
#include "common/export/text_file.h"
#include "robot/calibrate/calibration.h"

namespace
{

constexpr char usage[] =
    "usage: ale-calibrate LOG [--out FILE] [--plot F.svg]\n"
    "Fits the sensor's noise model to a recording of a scanner at rest: at a flat wall, or anywhere with "
    "walls at\n"
    "several distances and angles. LOG: any format that ale-replay reads; 300 scans (half a minute) are "
    "plenty.\n"
    "  --out FILE     where the [noise] section for the configuration goes (default: standard output)\n"
    "  --plot F.svg   the fit as a plot\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed, 2 wrong use.\n";

struct Options {
    std::string log;
    std::string out = "-";
    std::string plot;
};

void check_files(const Options &options)
{
    cli::Files files;
    files.reads("LOG", options.log);
    files.writes("--out", options.out);
    files.writes("--plot", options.plot);
}

void run(const Options &options)
{
    const calibrate::Recording recording = calibrate::read_recording(options.log);
    const calibrate::Calibration calibration = calibrate::calibrate(recording);
    const std::string source = std::filesystem::path(options.log).filename().string();
    ale::TextFile file(options.out);
    file.put(calibrate::ini_fragment(calibration, source));
    file.close();
    if (!options.plot.empty()) {
        calibrate::plot(calibration, source, options.plot);
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-calibrate", usage);
    line.argument("LOG", options.log);
    line.text("out", options.out);
    cli::drawing(line, "plot", options.plot);
    return line.run(argc, argv, [&] {
        check_files(options);
        run(options);
    });
}
