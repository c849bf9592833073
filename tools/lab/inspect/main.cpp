/* ale-inspect: draws one scan of a log and what the extractor decided about it. */
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/command_line/files.h"
#include "common/command_line/robot_files.h"
#include "common/log/log_reader.h"
#include "lab/inspect/picture.h"
#include "lab/inspect/sizes.h"

namespace
{

constexpr char usage[] =
    "usage: ale-inspect LOG SCAN [--out F.svg] [--config FILE]\n"
    "       ale-inspect --sizes\n"
    "Draws scan number SCAN (from 0, as in ale-replay --features) of a log: its points by segment, lines, "
    "corners,\n"
    "curves, candidates that were refused and by which test, and the steps of the search for the breaks.\n"
    "  --out F.svg    where to (default: standard output)\n"
    "  --config FILE  configuration as for ale-slamd: sections [noise] and [extract] count here\n"
    "  --sizes        prints instead what the objects cost whose memory a caller of libale provides\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed, 2 wrong use.\n";

constexpr long most_scans = 1000000000;

struct Options {
    std::string log;
    std::string out = "-";
    std::string config;
    std::string scan;
    bool sizes = false;
};

ale_extract_config_t extraction_of(const Options &options)
{
    ale_config_t config = ale_config_default();
    if (!options.config.empty()) {
        cli::load_config(options.config, config);
    }
    return config.pipeline.extract;
}

std::unique_ptr<ale_scan_t> scan_of(const Options &options)
{
    ale::LogReader log(options.log);
    const auto event = std::make_unique<ale_log_event_t>();
    const long wanted = std::stol(options.scan);
    long number = 0;
    while (log.next(*event)) {
        if (event->kind == ALE_LOG_SCAN && number++ == wanted) {
            return std::make_unique<ale_scan_t>(event->scan);
        }
    }
    throw std::runtime_error(options.log + ": has " + std::to_string(number) + " scans, there is no scan " +
                             options.scan);
}

void check(const Options &options)
{
    if (options.log.empty() || options.scan.empty()) {
        throw cli::WrongUse(options.log.empty() ? "LOG is missing" : "SCAN is missing");
    }
    cli::number_of("SCAN", options.scan, 0L, most_scans);
    cli::Files files;
    files.reads("LOG", options.log);
    files.reads("--config", options.config);
    files.writes("--out", options.out);
}

void run(const Options &options)
{
    const ale_extract_config_t config = extraction_of(options);
    const std::unique_ptr<ale_scan_t> scan = scan_of(options);
    const auto trace = std::make_unique<inspect_trace_t>();
    if (inspect_trace(scan.get(), &config, trace.get()) < 0) {
        throw std::runtime_error("the extractor does not take this configuration");
    }
    const std::string title =
        std::filesystem::path(options.log).filename().string() + ", scan " + options.scan;
    inspect::draw(*scan, *trace, title, options.out);
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-inspect", usage);
    line.possible_argument("LOG", options.log);
    line.possible_argument("SCAN", options.scan);
    cli::drawing(line, "out", options.out);
    line.text("config", options.config);
    line.flag("sizes", options.sizes);
    return line.run(argc, argv, [&] {
        if (options.sizes) {
            std::fputs(inspect::table_of_sizes().c_str(), stdout);
            return;
        }
        check(options);
        run(options);
    });
}
