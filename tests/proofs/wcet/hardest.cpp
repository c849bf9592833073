// Looks for the scan that costs the extractor most, by evolution: the costliest scans of a pool are changed
// at random, and what costs more replaces what costs less. Cost is the number of basic blocks entered, which
// the compiler's trace-pc instrumentation of lib counts and which goes with the instructions. Writes the
// costliest scans found as a log; `make bench-hardest` counts their instructions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "lab/bench/suite.hpp"

extern "C" {
#include "extract/extract.h"

static std::uint64_t blocks_entered;

void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void)
{
    blocks_entered++;
}
}

namespace
{

constexpr char usage[] =
    "usage: hardest STEPS SEED LOG\n"
    "Looks for the scan that costs the extractor most and writes the costliest as a log; JSON on stdout.\n"
    "  --help, --version\n";
constexpr int beams = 682;
constexpr int first_step = -340;
constexpr int nearest_mm = 22;
constexpr int farthest_mm = 5590;
constexpr std::size_t survivors = 24;

using Ranges = std::vector<int>; // mm

struct Candidate {
    Ranges ranges;
    std::uint64_t cost;
};

bool costlier(const Candidate &a, const Candidate &b)
{
    return a.cost > b.cost;
}

class Meter
{
  public:
    Meter()
        : memory_(ale_extractor_size()), scan_(std::make_unique<ale_scan_t>()),
          features_(std::make_unique<ale_features_t>())
    {
        const ale_extract_config_t config = ale_extract_default_config();
        ale_extractor_init(extractor(), &config);
        scan_->beams = beams;
        scan_->range_min_um = 20000;
        scan_->range_max_um = 5600000;
        scan_->step_bam = 1 << 22;
        scan_->first_bearing_bam = static_cast<std::uint32_t>(first_step) << 22;
    }

    std::uint64_t cost(const Ranges &ranges)
    {
        for (int k = 0; k < beams; k++) {
            ale_scan_set_range(scan_.get(), static_cast<std::uint16_t>(k),
                               ranges[static_cast<std::size_t>(k)] * 1000);
        }
        blocks_entered = 0;
        ale_extract_scan(extractor(), scan_.get(), nullptr, features_.get());
        return blocks_entered;
    }

  private:
    ale_extractor_t *extractor()
    {
        return reinterpret_cast<ale_extractor_t *>(memory_.data());
    }

    std::vector<char> memory_;
    std::unique_ptr<ale_scan_t> scan_;
    std::unique_ptr<ale_features_t> features_;
};

class Search
{
  public:
    explicit Search(unsigned seed) : engine_(seed)
    {
    }

    // Starts from the simulated suite and from made patterns; returns the mean cost of the suite.
    double start()
    {
        double sum = 0;
        int scans = 0;
        bench::for_each_case(bench::noise_kind("urg"), 20, 99, [&](const bench::Case &c) {
            Ranges ranges(beams, 0);
            for (int k = 0; k < std::min<int>(beams, c.simulated.scan->beams); k++) {
                ranges[static_cast<std::size_t>(k)] = c.simulated.scan->range_um[k] / 1000;
            }
            keep(ranges);
            sum += static_cast<double>(pool_.back().cost);
            scans++;
        });
        for (int k = 0; k < 200; k++) {
            keep(pattern());
        }
        std::sort(pool_.begin(), pool_.end(), costlier);
        pool_.resize(survivors);
        return sum / scans;
    }

    void step()
    {
        Candidate child = pool_[std::min(any(survivors), any(survivors))];
        const std::size_t changes = 1 + any(3);
        for (std::size_t k = 0; k < changes; k++) {
            change(child.ranges);
        }
        child.cost = meter_.cost(child.ranges);
        const bool known =
            std::any_of(pool_.begin(), pool_.end(), [&](const Candidate &c) { return c.cost == child.cost; });
        if (!known && child.cost > pool_.back().cost) {
            pool_.back() = child;
            std::sort(pool_.begin(), pool_.end(), costlier);
        }
    }

    const std::vector<Candidate> &pool() const
    {
        return pool_;
    }

  private:
    std::size_t any(std::size_t below)
    {
        return engine_() % below;
    }

    double gauss()
    {
        return std::normal_distribution<double>()(engine_);
    }

    static int bounded(double range_mm)
    {
        return static_cast<int>(std::clamp(range_mm, double{nearest_mm}, double{farthest_mm}));
    }

    void keep(const Ranges &ranges)
    {
        pool_.push_back({ranges, meter_.cost(ranges)});
    }

    // Zigzags, random walks, combs and waves with noise.
    Ranges pattern()
    {
        const auto period = static_cast<double>(5 + any(40));
        const auto height = static_cast<double>(20 + any(600));
        const auto base = static_cast<double>(300 + any(3000));
        const auto noise = static_cast<double>(any(4) ? any(30) : any(200));
        const std::size_t kind = any(4);
        Ranges ranges;
        double walk = base;
        for (int k = 0; k < beams; k++) {
            const double phase = std::fmod(k, period) / period;
            walk += gauss() * height / 20;
            const double shape[] = {base + height * std::fabs(phase - 0.5), walk,
                                    base + (std::fmod(k, 2 * period) < period ? height : 0),
                                    base + height * std::sin(2 * 3.14159265 * phase)};
            ranges.push_back(bounded(shape[kind] + gauss() * noise));
        }
        return ranges;
    }

    // One stretch of the scan: shifted, roughened, tilted, folded, or taken from another scan.
    void change(Ranges &ranges)
    {
        const std::size_t from = any(beams);
        const std::size_t to = std::min<std::size_t>(beams, from + 1 + any(any(2) ? 8 : 120));
        const Ranges &other = pool_[any(pool_.size())].ranges;
        const std::size_t turn = any(2) ? 0 : any(beams);
        const double shift = static_cast<double>(any(400)) - 200;
        const double sigma = std::pow(10, static_cast<double>(any(25)) / 10);
        const double tilt = (static_cast<double>(any(2001)) - 1000) / 100;
        const std::size_t kind = any(6);
        const int origin = ranges[from];
        for (std::size_t k = from; k < to; k++) {
            const double along = static_cast<double>(k - from);
            const double fold = std::fabs(along - static_cast<double>(to - from) / 2);
            const double changed[] = {ranges[k] + shift / 4,    ranges[k] + gauss() * sigma,
                                      ranges[k] + tilt * along, ranges[k] + tilt * fold,
                                      origin + tilt * along,    double(other[(k + turn) % beams])};
            ranges[k] = bounded(changed[kind]);
        }
    }

    std::mt19937 engine_;
    Meter meter_;
    std::vector<Candidate> pool_;
};

void write_log(const std::string &path, const std::vector<Candidate> &pool)
{
    const double step = 2 * 3.14159265358979323846 / 1024;
    std::ofstream out(path);
    for (std::size_t k = 0; k < pool.size(); k++) {
        out << "ROBOTLASER1 4 " << first_step * step << ' ' << step * (beams - 1) << ' ' << step
            << " 5.6 0.01 0 " << beams;
        for (const int range : pool[k].ranges) {
            out << ' ' << range * 1e-3;
        }
        out << " 0 0 0 0 0 0 0 0 0 0 0 0 " << static_cast<double>(k) * 0.1 << " x "
            << static_cast<double>(k) * 0.1 << '\n';
    }
    if (!out) {
        throw std::runtime_error(path + ": cannot be written");
    }
}

} // namespace

int main(int argc, char **argv)
{
    int steps = 0;
    unsigned seed = 0;
    std::string log;
    cli::CommandLine line("hardest", usage);
    line.argument("STEPS",
                  [&](const std::string &word) { steps = cli::number_of("STEPS", word, 0, 100000000); });
    line.argument("SEED",
                  [&](const std::string &word) { seed = cli::number_of("SEED", word, 0U, UINT32_MAX); });
    line.argument("LOG", log);
    return line.run(argc, argv, [&] {
        Search search(seed);
        const double mean = search.start();
        for (int k = 0; k < steps; k++) {
            search.step();
        }
        write_log(log, search.pool());
        std::cout << nlohmann::json{{"scans", search.pool().size()},
                                    {"times_the_mean",
                                     static_cast<double>(search.pool().front().cost) / mean}}
                         .dump()
                  << std::endl;
    });
}
