// lib/extract/run_list.c: which runs are kept of too many.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "lib/extract/as_reference.h"
#include "lib/extract/scene.h"

namespace
{

using Runs = std::vector<reference::Run>;

// Runs of random lengths, one after the other, of at most so many points.
Runs random_runs(int most, std::mt19937 &engine)
{
    Runs runs;
    std::uniform_int_distribution<int> points(ALE_MIN_RUN, most);
    for (int at = 0; at + most <= ALE_MAX_BEAMS && runs.size() < ALE_MAX_RUNS; at = runs.back().last + 1) {
        runs.push_back({at, at + points(engine) - 1});
    }
    return runs;
}

Runs mirrored(const Runs &runs)
{
    Runs result;
    for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
        result.push_back({ALE_MAX_BEAMS - 1 - run->last, ALE_MAX_BEAMS - 1 - run->first});
    }
    return result;
}

TEST(RunList, OfEnoughLongOnesTheShorterAndOfEquallyLongOnesTheOuterAreDropped)
{
    constexpr int fewest = 12;
    constexpr int enough = 24;
    scene::extractor extractor;
    ale_run_list_t *list = &extractor.get()->runs;
    list->scan.points.count = ALE_MAX_BEAMS;
    const auto kept_of = [&](const Runs &runs) {
        scene::set_runs(list, runs);
        ale_run_list_drop_short(list, fewest, enough);
        return scene::runs_of(*list);
    };
    const auto rank = [](const reference::Run &run) {
        return std::pair(run.points(), -std::abs(run.first + run.last + 1 - ALE_MAX_BEAMS));
    };
    std::mt19937 engine(3);
    for (const int most : {5, 8, 12, 13, 14, 15, 16, 20, 30, 45, 90}) {
        const Runs runs = random_runs(most, engine);
        const Runs kept = kept_of(runs);
        const auto long_enough = std::count_if(
            runs.begin(), runs.end(), [](const reference::Run &run) { return run.points() >= fewest; });
        EXPECT_GE(kept.size(), std::min<size_t>(enough, static_cast<size_t>(long_enough))) << most;
        EXPECT_LE(kept.size(), std::min<size_t>(enough + 1, static_cast<size_t>(long_enough))) << most;
        for (const reference::Run &run : runs) {
            if (std::find(kept.begin(), kept.end(), run) == kept.end() && run.points() >= fewest) {
                EXPECT_TRUE(std::all_of(kept.begin(), kept.end(), [&](const reference::Run &other) {
                    return rank(other) > rank(run);
                }));
            }
        }
        EXPECT_EQ(kept_of(mirrored(runs)), mirrored(kept)) << most;
    }
}

} // namespace
