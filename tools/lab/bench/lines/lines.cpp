// bench-lines: the extractors over simulated suites and recordings of a resting scanner; JSON on stdout.
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/command_line/command_line.h"
#include "lab/bench/lines/extractors.hpp"
#include "lab/bench/lines/repeatability.hpp"
#include "lab/bench/lines/score.hpp"
#include "lab/bench/lines/standstill.hpp"
#include "lab/bench/lines/stated_error.hpp"
#include "lab/bench/suite.hpp"

namespace
{

using nlohmann::json;
using namespace bench;

constexpr char usage[] =
    "usage: lines accuracy [--scans N] [--seed S] [--threshold MM,PERCENT] [--noise NAME] [--extractor "
    "NAME]\n"
    "       lines turn --turn BEAMS [--scans N] [--seed S] [--noise NAME]  a scanner of a whole turn, "
    "wherever it\n"
    "                                                  begins and whichever way it turns; libale alone\n"
    "       lines run --extractor NAME [--scans N]     only extracts, over the urg suite: for profilers\n"
    "       lines rest LOG [--views]                   repeatability where a recorded scanner rests, "
    "--views: "
    "mirrored\n"
    "                                                  and thinned, too\n"
    "       lines write DIR [--scans N] [--noise NAME] scans.log and truth.jsonl\n"
    "The extractors over simulated suites and recordings of a resting scanner; JSON on stdout.\n"
    "  --help, --version\n";

struct Options {
    std::string path;
    std::string noise;     // empty: all
    std::string extractor; // empty: all
    int scans = 20;        // of each kind of world
    std::uint64_t seed = 1;
    std::optional<Threshold> threshold;
    int turn_beams = 0;
    bool views = false;
};

std::vector<Extractor> chosen_extractors(const Options &options)
{
    std::vector<Extractor> chosen;
    for (const Extractor &e : extractors(options.threshold)) {
        if (options.extractor.empty() || options.extractor == e.name) {
            chosen.push_back(e);
        }
    }
    if (chosen.empty()) {
        throw cli::WrongUse("no extractor is called " + options.extractor);
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

// Found in a turn that begins at beam `seam`, by the beams of the turn that begins at 0.
Extraction turned_back(Extraction found, int beams, int seam, bool clockwise)
{
    for (Line &line : found.lines) {
        const int length = (line.last - line.first + beams) % beams;
        const int first = clockwise ? seam - line.last : seam + line.first;
        line.first = (first + 2 * beams) % beams;
        const bool mostly_behind = 2 * (line.first + length - beams) > length; // the true seam, at beam 0
        line.first -= mostly_behind ? beams : 0;
        line.last = line.first + length;
    }
    return found;
}

json turn_row(const Noise &noise, const Options &options)
{
    Tally all;
    Tally straight;
    int scans = 0;
    Random random(options.seed);
    const Extractor extractor = chosen_extractors(options).front();
    for_each_case(
        noise, options.scans, options.seed,
        [&](const Case &c) {
            const int seam = random.integer(0, options.turn_beams - 1);
            const bool clockwise = random.chance(0.5);
            const Extraction found = extractor.extract(*turned(*c.simulated.scan, seam, clockwise));
            const Tally tally = score(c.truth, turned_back(found, options.turn_beams, seam, clockwise));
            scans++;
            all.add(tally);
            if (!is_curved(c.truth.kind)) {
                straight.add(tally);
            }
        },
        options.turn_beams);
    json row = figures(all, straight);
    row["noise"] = noise.name;
    row["scans"] = scans;
    row["beams"] = options.turn_beams;
    return row;
}

void turn(const Options &options)
{
    for (const Noise &noise : chosen_noises(options)) {
        std::cout << turn_row(noise, options).dump() << std::endl;
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

constexpr std::size_t least_at_rest = 15; // scans

using View = std::function<std::unique_ptr<ale_scan_t>(const ale_scan_t &)>;

// What is general in how a scene at rest is seen holds in its mirror image and with fewer beams.
const std::vector<std::pair<const char *, View>> views = {
    {"as recorded", [](const ale_scan_t &scan) { return std::make_unique<ale_scan_t>(scan); }},
    {"mirrored", mirrored},
    {"every second beam", [](const ale_scan_t &scan) { return thinned(scan, 2); }},
};

json rest_row(const Standstill &standstill, const View &view, const Extractor &extractor)
{
    std::vector<std::vector<Line>> found;
    for (const auto &scan : standstill.scans) {
        found.push_back(extractor.extract(*view(*scan)).lines);
    }
    const Repeatability r = repeatability(found);
    const StatedError stated = stated_error(found);
    return {{"extractor", extractor.name},
            {"title", extractor.title},
            {"first_scan", standstill.first_scan},
            {"scans", found.size()},
            {"walls", r.walls},
            {"seen", r.seen},
            {"pieces", r.pieces},
            {"stray", r.stray},
            {"end_beams", r.end_rms},
            {"surfaces", stated.surfaces},
            {"direction_squared", stated.squared},
            {"direction_worst", stated.worst}};
}

void rest(const Options &options)
{
    const std::vector<Standstill> stretches = standstills(options.path, least_at_rest);
    if (stretches.empty()) {
        throw std::runtime_error(options.path + ": the scanner never rests for " +
                                 std::to_string(least_at_rest) + " scans");
    }
    const std::size_t shown = options.views ? views.size() : 1;
    for (const Standstill &standstill : stretches) {
        for (std::size_t k = 0; k < shown; k++) {
            for (const Extractor &extractor : chosen_extractors(options)) {
                json row = rest_row(standstill, views[k].second, extractor);
                row["view"] = views[k].first;
                std::cout << row.dump() << std::endl;
            }
        }
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

Threshold threshold_of(const std::string &word)
{
    const std::size_t comma = word.find(',');
    if (comma == std::string::npos) {
        throw cli::WrongUse("--threshold " + word + ": expected MM,PERCENT");
    }
    const std::string where = "--threshold " + word + ":";
    return {cli::number_of(where, word.substr(0, comma), 0.0, 1000.0) * 1e-3,
            cli::number_of(where, word.substr(comma + 1), 0.0, 100.0) * 1e-2};
}

} // namespace

int main(int argc, char **argv)
{
    using Command = void (*)(const Options &);
    const cli::Choices<Command> commands = {
        {"accuracy", accuracy}, {"turn", turn}, {"run", run}, {"rest", rest}, {"write", write}};
    Options options;
    Command command = nullptr;
    cli::CommandLine line("lines", usage);
    line.argument("COMMAND",
                  [&](const std::string &word) { command = cli::choice_of("COMMAND", word, commands); });
    line.possible_argument("PATH", options.path);
    line.text("noise", options.noise);
    line.text("extractor", options.extractor);
    line.number("scans", options.scans, 1, 1000000);
    line.number("seed", options.seed, std::uint64_t{0}, UINT64_MAX);
    line.number("turn", options.turn_beams, 90, ALE_MAX_BEAMS);
    line.flag("views", options.views);
    line.option("threshold", [&](const std::string &word) { options.threshold = threshold_of(word); });
    return line.run(argc, argv, [&] {
        if (options.path.empty() == (command == rest || command == write)) {
            throw cli::WrongUse("rest wants a LOG, write a folder, the others neither");
        }
        if ((command == turn) != (options.turn_beams > 0)) {
            throw cli::WrongUse("turn, and nothing else, wants --turn BEAMS");
        }
        command(options);
    });
}
