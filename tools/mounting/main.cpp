/* ale-mounting: where the scanner sits, how the wheels err and how late they are, from a recorded drive. */
#include <cstdio>
#include <filesystem>
#include <getopt.h>
#include <stdexcept>
#include <string>

#include "export/text_file.h"
#include "mounting/report.h"

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

int wrong_use(const std::string &what)
{
    std::fprintf(stderr, "ale-mounting: %s (see --help)\n", what.c_str());
    return 2;
}

/* The exit code when the command line has been answered, else -1 and options filled. */
int parse(int argc, char **argv, Options &options)
{
    enum { OUT = 1, CONFIG, HELP, VERSION };
    const option known[] = {{"out", required_argument, nullptr, OUT},
                            {"config", required_argument, nullptr, CONFIG},
                            {"help", no_argument, nullptr, HELP},
                            {"version", no_argument, nullptr, VERSION},
                            {nullptr, 0, nullptr, 0}};
    for (int choice; (choice = getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        switch (choice) {
        case OUT:
            options.out = optarg;
            break;
        case CONFIG:
            options.config = optarg;
            break;
        case HELP:
            std::fputs(usage, stdout);
            return 0;
        case VERSION:
            std::puts("ale-mounting 0.1.0");
            return 0;
        default:
            return 2;
        }
    }
    if (optind + 1 != argc) {
        return wrong_use(optind >= argc ? "which log?" : "one log at a time");
    }
    options.log = argv[optind];
    return -1;
}

mounting::Fit fit_of(const Options &options)
{
    const mounting::Drive drive = mounting::read_drive(options.log, options.config);
    try {
        return mounting::fit(drive);
    } catch (const std::runtime_error &error) {
        throw std::runtime_error(options.log + ": " + error.what());
    }
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
    if (const int answered = parse(argc, argv, options); answered >= 0) {
        return answered;
    }
    try {
        run(options);
        return 0;
    } catch (const std::invalid_argument &error) {
        std::fprintf(stderr, "ale-mounting: %s\n", error.what());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-mounting: %s\n", error.what());
        return 1;
    }
}
