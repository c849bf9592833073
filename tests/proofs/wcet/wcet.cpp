/* What the estimate task's work on one scan costs, in instructions or in cycles: over recorded scans, and
 * over scans that a search makes as expensive as it can. Run by `make wcet` and `make wcet-cycles`. */
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/log/log_reader.h"
#include "lab/bench/random.hpp"
#include "proofs/wcet/bound.hpp"
#include "proofs/wcet/cost_counter.hpp"
#include "proofs/wcet/scans.hpp"

namespace
{

using bench::CostCounter;
using bench::Costly;
using Counts = std::array<uint64_t, ALE_STAGES>;

constexpr char usage[] =
    "usage: valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file=BASE wcet --counts BASE\n"
    "                [--tries N] [--seed S] LOG...\n"
    "What the estimate task's work on one scan costs: the scans of the logs, and the most expensive scan\n"
    "that a search of N steps (default 0) finds, S (default 11) being the seed of its random changes.\n"
    "`make wcet` runs it, and `make wcet-cycles` for ARM under qemu.\n"
    "  --help, --version\n";
constexpr std::array<const char *, ALE_STAGES> stage_names = {"deskew", "smooth", "extract", "match", "map"};
constexpr int scans_of_a_candidate = 16;
/* At 1 GHz the time from one scan to the next, and a fifth of it; of instructions what is promised. */
constexpr uint64_t most_of_any_scan = CostCounter::counts_cycles ? 100000000 : 10000000;
constexpr uint64_t most_of_the_mean = CostCounter::counts_cycles ? 20000000 : 1200000;

uint64_t sum(const Counts &counts)
{
    return std::accumulate(counts.begin(), counts.end(), uint64_t{0});
}

/* The estimate task's work, counted stage by stage. */
class Counted
{
  public:
    Counted(CostCounter &counter, const ale_pipeline_config_t &config)
        : counter_(counter),
          pipeline_(static_cast<ale_pipeline_t *>(operator new(ale_pipeline_size(), alignment)))
    {
        if (ale_pipeline_init(pipeline_.get(), &config) < 0) {
            throw std::runtime_error("the pipeline refuses its configuration");
        }
        const ale_stage_hook_t hook = {end_of_stage, this};
        ale_pipeline_set_hook(pipeline_.get(), &hook);
    }

    ale_pipeline_t *operator*() const
    {
        return pipeline_.get();
    }

    Counts scan(const ale_scan_t &scan)
    {
        ale_estimate_t estimate;
        counts_ = {};
        CostCounter::toggle();
        ale_pipeline_scan(pipeline_.get(), &scan, &estimate);
        CostCounter::toggle();
        counts_[ALE_STAGE_MAP] += counter_.take(); /* the answer itself */
        return counts_;
    }

  private:
    static constexpr std::align_val_t alignment{alignof(std::max_align_t)};
    struct Free {
        void operator()(ale_pipeline_t *pipeline) const
        {
            operator delete(pipeline, alignment);
        }
    };

    static void end_of_stage(void *user, ale_stage_t stage)
    {
        CostCounter::toggle();
        auto *self = static_cast<Counted *>(user);
        self->counts_[stage] += self->counter_.take();
        CostCounter::toggle();
    }

    CostCounter &counter_;
    std::unique_ptr<ale_pipeline_t, Free> pipeline_;
    Counts counts_{};
};

struct Tally {
    std::vector<uint64_t> totals;
    Counts worst_stage{};
    Counts worst{}; /* the stages of the most expensive scan */

    void add(const Counts &counts)
    {
        totals.push_back(sum(counts));
        for (size_t k = 0; k < counts.size(); k++) {
            worst_stage[k] = std::max(worst_stage[k], counts[k]);
        }
        worst = sum(counts) > sum(worst) ? counts : worst;
    }
    uint64_t mean() const
    {
        return std::accumulate(totals.begin(), totals.end(), uint64_t{0}) / totals.size();
    }
};

void print_row(const char *name, const Counts &counts)
{
    std::printf("%-34s", name);
    for (const uint64_t count : counts) {
        std::printf(" %9llu", static_cast<unsigned long long>(count));
    }
    std::printf(" %10llu\n", static_cast<unsigned long long>(sum(counts)));
    std::fflush(stdout);
}

void count_log(CostCounter &counter, const std::string &path, Tally &all)
{
    ale::LogReader log(path);
    Counted counted(counter, ale_pipeline_default_config());
    auto event = std::make_unique<ale_log_event_t>();
    Tally tally;
    while (log.next(*event)) {
        if (event->kind == ALE_LOG_ODOMETRY) {
            ale_pipeline_odometry(*counted, &event->odometry);
        } else if (event->kind == ALE_LOG_SCAN) {
            const Counts counts = counted.scan(event->scan);
            tally.add(counts);
            all.add(counts);
        }
    }
    const std::string name = path.substr(path.rfind('/') + 1);
    std::printf("%-34s %zu scans, mean %llu\n", name.c_str(), tally.totals.size(),
                static_cast<unsigned long long>(tally.mean()));
    print_row("  its most expensive scan", tally.worst);
}

/* The most expensive of a candidate's scans. */
Counts cost(CostCounter &counter, const Costly &costly, Tally &stages)
{
    bench::Random random(7);
    Counted counted(counter, ale_pipeline_default_config());
    const auto map = bench::map_of(costly, random);
    if (map->line_count > 0) {
        ale_pipeline_load_map(*counted, map.get(), 1, ale_pose_t{}, true);
    }
    Tally tally;
    for (int k = 0; k < scans_of_a_candidate; k++) {
        for (const ale_odometry_t &sample : bench::wheels_before(costly, k)) {
            ale_pipeline_odometry(*counted, &sample);
        }
        const ale_scan_t scan = bench::scan_of(costly, k, random);
        const Counts counts = counted.scan(scan);
        tally.add(counts);
        stages.add(counts);
    }
    return tally.worst;
}

std::vector<std::pair<std::string, Costly>> beginnings()
{
    Costly zigzag;
    Costly corners;
    corners.square = 1;
    corners.tooth_beams = 16;
    Costly dropouts;
    dropouts.dropped = 0.5;
    Costly turning = zigzag;
    turning.turn_rad_s = 1;
    Costly jolted = turning; /* what the map does not explain is fitted twice */
    jolted.noise_m = 0.01;
    jolted.dropped = 0.01;
    jolted.jump_rad = 0.15;
    Costly full_map = turning;
    full_map.map_walls = ALE_MAP_MAX_LINES;
    Costly lost = full_map;
    lost.jump_rad = 2;
    Costly unwatched = lost; /* it can have got anywhere within reach of a vote */
    unwatched.gap_s = 2;
    return {
        {"zigzag", zigzag},       {"all corners", corners},          {"every other beam dropped", dropouts},
        {"turning", turning},     {"turning, jolted", jolted},       {"full map", full_map},
        {"full map, lost", lost}, {"the same, unwatched", unwatched}};
}

struct Effort {
    int tries = 0;
    int seed = 11;
};

/* Hill climbing from the most expensive beginning. */
Costly search(CostCounter &counter, const Effort &effort, Tally &stages)
{
    Costly best;
    Counts best_cost{};
    for (const auto &[name, costly] : beginnings()) {
        const Counts counts = cost(counter, costly, stages);
        print_row(name.c_str(), counts);
        if (sum(counts) > sum(best_cost)) {
            best = costly;
            best_cost = counts;
        }
    }
    bench::Random random(static_cast<uint64_t>(effort.seed));
    for (int k = 0; k < effort.tries; k++) {
        const Costly candidate = bench::changed(best, random);
        const Counts counts = cost(counter, candidate, stages);
        if (sum(counts) > sum(best_cost)) {
            best = candidate;
            best_cost = counts;
        }
    }
    print_row("most expensive scan found", best_cost);
    std::printf("  it is: %s\n", best.words().c_str());
    return best;
}

uint64_t in_all(const bench::BoundPart &part)
{
    return static_cast<uint64_t>(part.times) * part.each;
}

/* Returns their sum. */
uint64_t print_parts(const std::vector<bench::BoundPart> &parts)
{
    uint64_t sum = 0;
    for (const bench::BoundPart &part : parts) {
        std::printf("%-34s %9d %9llu %10llu\n", part.name.c_str(), part.times,
                    static_cast<unsigned long long>(part.each),
                    static_cast<unsigned long long>(in_all(part)));
        sum += in_all(part);
    }
    return sum;
}

uint64_t most(const std::vector<bench::BoundPart> &parts)
{
    uint64_t most = 0;
    for (const bench::BoundPart &part : parts) {
        most = std::max(most, in_all(part));
    }
    return most;
}

/* The parts of a scan's way at their capacities, and the most that those of one scan come to: none can cost
 * more. */
uint64_t print_bound(CostCounter &counter)
{
    std::printf("\n%-34s %9s %9s %10s\n", "at its capacity", "at most", "each", "in all");
    const bench::Bound bound = bench::bound_of_a_scan(counter);
    const uint64_t tracked = print_parts(bound.any_scan) + print_parts(bound.tracked);
    const uint64_t lost = print_parts(bound.lost);
    std::printf("and one of these\n");
    print_parts(bound.one_of);
    std::printf("\na tracked scan, all filled     %llu\n", static_cast<unsigned long long>(tracked));
    return tracked + lost + most(bound.one_of);
}

bool report(const char *name, uint64_t count, uint64_t most)
{
    std::printf("%-30s %llu of %llu%s\n", name, static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(most), count > most ? ": too much" : "");
    return count <= most;
}

/* Whether scans cost no more than they may, in the mean, at most, and by the bound. */
bool run(const std::string &base, const Effort &effort, const std::vector<std::string> &logs)
{
    CostCounter counter(base);
    Tally recorded;
    Tally made;
    std::printf("%-34s", CostCounter::counts_cycles ? "cycles of a scan" : "instructions of a scan");
    for (const char *name : stage_names) {
        std::printf(" %9s", name);
    }
    std::printf(" %10s\n", "in all");
    for (const std::string &log : logs) {
        count_log(counter, log, recorded);
    }
    search(counter, effort, made);
    const uint64_t bound = print_bound(counter);
    const uint64_t worst = std::max(sum(made.worst), sum(recorded.worst));
    const bool mean = report("mean recorded scan", recorded.mean(), most_of_the_mean);
    const bool found = report("most expensive scan found", worst, most_of_any_scan);
    const bool proved = report("any scan, all filled", bound, most_of_any_scan);
    return mean && found && proved && worst <= bound;
}

} // namespace

int main(int argc, char **argv)
{
    std::string counts;
    Effort effort;
    std::vector<std::string> logs;
    cli::CommandLine line("wcet", usage);
    line.text("counts", counts);
    line.number("tries", effort.tries, 0, 1000000);
    line.number("seed", effort.seed, 0, 1000000);
    line.rest(logs);
    return line.run(argc, argv, [&] {
        if (!CostCounter::may_be_there() || counts.empty() || logs.empty()) {
            throw cli::WrongUse("needs callgrind or qemu, --counts BASE and a log: make wcet");
        }
        if (!run(counts, effort, logs)) {
            throw std::runtime_error("a scan costs too much");
        }
    });
}
