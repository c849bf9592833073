/* ale-calibrate: fits the noise model to a recording of a scanner at rest. */
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "calibrate/calibration.h"
#include "export/text_file.h"

namespace
{

#ifndef ALE_VERSION
#define ALE_VERSION "0.1"
#endif

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

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

Options parse(int argc, char **argv)
{
    Options options;
    for (int k = 1; k < argc; k++) {
        const std::string word = argv[k];
        if (word == "--out" || word == "--plot") {
            if (++k >= argc) {
                throw UsageError(word + " needs a file name");
            }
            (word == "--out" ? options.out : options.plot) = argv[k];
        } else if (word.size() > 1 && word[0] == '-') {
            throw UsageError("unknown option " + word);
        } else if (options.log.empty()) {
            options.log = word;
        } else {
            throw UsageError("one LOG at a time, not also " + word);
        }
    }
    if (options.log.empty()) {
        throw UsageError("LOG is missing");
    }
    return options;
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

bool asks_for(int argc, char **argv, const std::string &option)
{
    for (int k = 1; k < argc; k++) {
        if (argv[k] == option) {
            return true;
        }
    }
    return false;
}

} // namespace

int main(int argc, char **argv)
{
    if (asks_for(argc, argv, "--help")) {
        std::fputs(usage, stdout);
        return 0;
    }
    if (asks_for(argc, argv, "--version")) {
        std::puts("ale-calibrate " ALE_VERSION);
        return 0;
    }
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const UsageError &e) {
        std::fprintf(stderr, "ale-calibrate: %s (--help tells more)\n", e.what());
        return 2;
    } catch (const std::exception &e) {
        std::fprintf(stderr, "ale-calibrate: %s\n", e.what());
        return 1;
    }
}
