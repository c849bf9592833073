// bench-lines: the extractors over simulated suites and recordings of a resting scanner; JSON on stdout.
//
//   lines accuracy [--scans N] [--seed S] [--threshold MM PERCENT] [--noise NAME] [--extractor NAME]
//   lines run --extractor NAME [--scans N]     only extracts, over the urg suite: for profilers
//   lines rest LOG                             repeatability on a recording
//   lines write DIR [--scans N] [--noise NAME] scans.log and truth.jsonl
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/repeatability.hpp"
#include "bench/score.hpp"
#include "bench/suite.hpp"

extern "C" {
#include "log/log.h"
}

namespace
{

using nlohmann::json;
using namespace bench;

struct Options {
    std::string command;
    std::string path;
    std::string noise;     // empty: all
    std::string extractor; // empty: all
    int scans = 20;        // of each kind of world
    std::uint64_t seed = 1;
    std::optional<Threshold> threshold;
};

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

Options parse(int argc, char **argv)
{
    Options options;
    for (int k = 1; k < argc; k++) {
        const std::string word = argv[k];
        const auto value = [&] {
            if (++k >= argc) {
                throw UsageError(word + " needs a value");
            }
            return std::string(argv[k]);
        };
        if (word == "--noise") {
            options.noise = value();
        } else if (word == "--extractor") {
            options.extractor = value();
        } else if (word == "--scans") {
            options.scans = std::stoi(value());
        } else if (word == "--seed") {
            options.seed = std::stoull(value());
        } else if (word == "--threshold") {
            const double floor = std::stod(value());
            options.threshold = Threshold{floor * 1e-3, std::stod(value()) * 1e-2};
        } else if (word.rfind("--", 0) == 0) {
            throw UsageError("unknown option " + word);
        } else {
            (options.command.empty() ? options.command : options.path) = word;
        }
    }
    return options;
}

std::vector<Extractor> chosen_extractors(const Options &options)
{
    std::vector<Extractor> chosen;
    for (const Extractor &e : extractors(options.threshold)) {
        if (options.extractor.empty() || options.extractor == e.name) {
            chosen.push_back(e);
        }
    }
    if (chosen.empty()) {
        throw UsageError("no extractor is called " + options.extractor);
    }
    return chosen;
}

std::vector<Noise> chosen_noises(const Options &options)
{
    return options.noise.empty() ? noise_kinds() : std::vector<Noise>{noise_kind(options.noise)};
}

json figures(const Tally &all, const Tally &straight)
{
    return {{"true_lines", all.true_lines},
            {"tp", all.true_positive()},
            {"fp", all.false_positive()},
            {"fp_straight", straight.false_positive()},
            {"error_rms", all.error_rms()},
            {"error_median", all.error_median()},
            {"end_mm", 1e3 * all.end_median()},
            {"end_90_mm", 1e3 * all.end_90()},
            {"corner_precision", all.corner_precision()},
            {"corner_recall", all.corner_recall()},
            {"corner_mm", 1e3 * all.corner_rms()}};
}

json rows_of(const Noise &noise, const Options &options, const Extractor &extractor)
{
    Tally all;
    Tally straight;
    std::map<std::string, Tally> by_kind;
    double seconds = 0;
    int scans = 0;
    for_each_case(noise, options.scans, options.seed, [&](const Case &c) {
        const std::clock_t begun = std::clock();
        const Extraction extraction = extractor.extract(*c.simulated.scan);
        seconds += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
        scans++;
        const Tally tally = score(c.truth, extraction);
        all.add(tally);
        by_kind[c.truth.kind].add(tally);
        if (!is_curved(c.truth.kind)) {
            straight.add(tally);
        }
    });
    json row = figures(all, straight);
    row["noise"] = noise.name;
    row["extractor"] = extractor.name;
    row["title"] = extractor.title;
    row["function"] = extractor.function;
    row["scans"] = scans;
    row["us_a_scan"] = 1e6 * seconds / scans;
    for (const auto &[kind, tally] : by_kind) {
        row["kinds"][kind] = {{"tp", tally.true_positive()}, {"fp", tally.false_positive()}};
    }
    return row;
}

void accuracy(const Options &options)
{
    for (const Noise &noise : chosen_noises(options)) {
        for (const Extractor &extractor : chosen_extractors(options)) {
            std::cout << rows_of(noise, options, extractor).dump() << std::endl;
        }
    }
}

void run(const Options &options)
{
    const Extractor extractor = chosen_extractors(options).front();
    std::size_t lines = 0;
    int scans = 0;
    for_each_case(noise_kind("urg"), options.scans, options.seed, [&](const Case &c) {
        lines += extractor.extract(*c.simulated.scan).lines.size();
        scans++;
    });
    std::cout << json{{"extractor", extractor.name}, {"scans", scans}, {"lines", lines}}.dump() << std::endl;
}

struct CloseLog {
    void operator()(ale_log_t *log) const
    {
        ale_log_close(log);
    }
};

// Every scan of a log, one after the other.
void for_each_scan(const std::string &path, const std::function<void(const ale_scan_t &)> &visit)
{
    ale_log_t *opened = nullptr;
    ale_log_error_t error;
    if (ale_log_open(&opened, path.c_str(), &error) < 0) {
        throw std::runtime_error(error.message);
    }
    const std::unique_ptr<ale_log_t, CloseLog> log(opened);
    const auto event = std::make_unique<ale_log_event_t>();
    while (ale_log_next(log.get(), event.get()) > 0) {
        if (event->kind == ALE_LOG_SCAN) {
            visit(event->scan);
        }
    }
}

void rest(const Options &options)
{
    for (const Extractor &extractor : chosen_extractors(options)) {
        std::vector<std::vector<Line>> scans;
        for_each_scan(options.path,
                      [&](const ale_scan_t &scan) { scans.push_back(extractor.extract(scan).lines); });
        if (scans.empty()) {
            throw std::runtime_error(options.path + ": no scan");
        }
        const Repeatability r = repeatability(scans);
        std::cout << json{{"extractor", extractor.name},
                          {"title", extractor.title},
                          {"scans", scans.size()},
                          {"walls", r.walls},
                          {"seen", r.seen},
                          {"pieces", r.pieces},
                          {"stray", r.stray},
                          {"end_beams", r.end_rms}}
                         .dump()
                  << std::endl;
    }
}

json as_json(const TrueLine &line)
{
    return {{"wall", line.wall},
            {"first", line.first},
            {"last", line.last},
            {"n", line.points},
            {"x1", line.start.x()},
            {"y1", line.start.y()},
            {"x2", line.end.x()},
            {"y2", line.end.y()},
            {"t1", line.start_between},
            {"t2", line.end_between},
            {"alpha", line.form.alpha},
            {"rho", line.form.rho},
            {"len", (line.end - line.start).norm()},
            {"info", line.information},
            {"count", line.counts}};
}

json as_json(const Case &c)
{
    json lines = json::array();
    for (const TrueLine &line : c.truth.lines) {
        lines.push_back(as_json(line));
    }
    json corners = json::array();
    for (const TrueCorner &corner : c.truth.corners) {
        corners.push_back({{"x", corner.p.x()}, {"y", corner.p.y()}, {"count", corner.counts}});
    }
    return {{"scan", c.number}, {"kind", c.truth.kind}, {"lines", lines}, {"corners", corners}};
}

// A CARMEN line as the suites of others have it.
void write_scan(std::ostream &log, const ale_scan_t &scan, int number)
{
    char word[64];
    log << "ROBOTLASER1 2 -2.086213872 4.178563666 0.006135923 4.094 0.010 0 " << scan.beams;
    for (int k = 0; k < scan.beams; k++) {
        std::snprintf(word, sizeof word, " %.3f", scan.range_um[k] * 1e-6);
        log << word;
    }
    std::snprintf(word, sizeof word, "%.1f", number * 0.1);
    log << " 0 0 0 0 0 0 0 0 0 0 0 0 " << word << " bench " << word << "\n";
}

void write(const Options &options)
{
    std::ofstream log(options.path + "/scans.log");
    std::ofstream truth(options.path + "/truth.jsonl");
    for_each_case(noise_kind(options.noise.empty() ? "urg" : options.noise), options.scans, options.seed,
                  [&](const Case &c) {
                      write_scan(log, *c.simulated.scan, c.number);
                      truth << as_json(c).dump() << "\n";
                  });
    if (!log.flush() || !truth.flush()) {
        throw std::runtime_error(options.path + ": cannot write scans.log and truth.jsonl");
    }
}

int dispatch(const Options &options)
{
    static const std::map<std::string, void (*)(const Options &)> commands{
        {"accuracy", accuracy}, {"run", run}, {"rest", rest}, {"write", write}};
    const auto command = commands.find(options.command);
    if (command == commands.end()) {
        throw UsageError("usage: lines accuracy|run|rest LOG|write DIR [--scans N] [--seed S] [--noise NAME] "
                         "[--extractor NAME] [--threshold MM PERCENT]");
    }
    command->second(options);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    try {
        return dispatch(parse(argc, argv));
    } catch (const UsageError &e) {
        std::cerr << e.what() << "\n";
        return 2;
    } catch (const std::exception &e) {
        std::cerr << e.what() << "\n";
        return 1;
    }
}
