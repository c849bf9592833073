/* ale-inspect: draws one scan of a log and what the extractor decided about it. */
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "inspect/picture.h"

extern "C" {
#include "config.h"
#include "log/log.h"
}

namespace
{

#ifndef ALE_VERSION
#define ALE_VERSION "0.1"
#endif

constexpr char usage[] =
    "usage: ale-inspect LOG SCAN [--out F.svg] [--config FILE]\n"
    "Draws scan number SCAN (from 0, as in ale-replay --features) of a log: its points by segment, lines, "
    "corners,\n"
    "curves, candidates that were refused and by which test, and the steps of the search for the breaks.\n"
    "  --out F.svg    where to (default: standard output)\n"
    "  --config FILE  configuration as for ale-slamd: sections [noise] and [extract] count here\n"
    "  --help, --version\n"
    "Exit 0 fine, 1 failed, 2 wrong use.\n";

struct Options {
    std::string log;
    std::string out = "-";
    std::string config;
    long scan = -1;
};

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

long scan_number(const std::string &word)
{
    char *end = nullptr;
    errno = 0;
    const long number = std::strtol(word.c_str(), &end, 10);
    if (errno != 0 || end == word.c_str() || *end != '\0' || number < 0) {
        throw UsageError("SCAN is a number from 0, not " + word);
    }
    return number;
}

Options parse(int argc, char **argv)
{
    Options options;
    for (int k = 1; k < argc; k++) {
        const std::string word = argv[k];
        if (word == "--out" || word == "--config") {
            if (++k >= argc) {
                throw UsageError(word + " needs a file name");
            }
            (word == "--out" ? options.out : options.config) = argv[k];
        } else if (word.rfind("--", 0) == 0) {
            throw UsageError("unknown option " + word);
        } else if (options.log.empty()) {
            options.log = word;
        } else if (options.scan < 0) {
            options.scan = scan_number(word);
        } else {
            throw UsageError("too many words, from " + word + " on");
        }
    }
    if (options.scan < 0) {
        throw UsageError("LOG and SCAN are needed");
    }
    return options;
}

ale_extract_config_t extraction_of(const Options &options)
{
    ale_config_t config = ale_config_default();
    ale_config_error_t error;
    if (!options.config.empty() && ale_config_load(options.config.c_str(), &config, &error) < 0) {
        throw UsageError(error.message);
    }
    return config.pipeline.extract;
}

struct CloseLog {
    void operator()(ale_log_t *log) const
    {
        ale_log_close(log);
    }
};

std::unique_ptr<ale_scan_t> scan_of(const Options &options)
{
    ale_log_t *opened = nullptr;
    ale_log_error_t error;
    if (ale_log_open(&opened, options.log.c_str(), &error) < 0) {
        throw std::runtime_error(error.message);
    }
    const std::unique_ptr<ale_log_t, CloseLog> log(opened);
    const auto event = std::make_unique<ale_log_event_t>();
    long number = 0;
    while (ale_log_next(log.get(), event.get()) > 0) {
        if (event->kind == ALE_LOG_SCAN && number++ == options.scan) {
            return std::make_unique<ale_scan_t>(event->scan);
        }
    }
    throw std::runtime_error(options.log + ": has " + std::to_string(number) + " scans, there is no scan " +
                             std::to_string(options.scan));
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
        std::filesystem::path(options.log).filename().string() + ", scan " + std::to_string(options.scan);
    inspect::draw(*scan, *trace, title, options.out);
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
        std::puts("ale-inspect " ALE_VERSION);
        return 0;
    }
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const UsageError &e) {
        std::fprintf(stderr, "ale-inspect: %s\n", e.what());
        return 2;
    } catch (const std::exception &e) {
        std::fprintf(stderr, "ale-inspect: %s\n", e.what());
        return 1;
    }
}
