// lib/extract/runs.c, breakpoint.c, merge.c and curve.c against their twins in double, each stage on equal
// input.
#include <algorithm>
#include <functional>
#include <random>

#include "lib/extract/agreement.h"
#include "lib/extract/as_reference.h"
#include "lib/extract/stages.h"
#include "reference/curved_runs.h"
#include "reference/joint_break.h"
#include "reference/line_search.h"
#include "reference/run_fit.h"
#include "reference/run_merge.h"
#include "reference/trimmed_run.h"

namespace
{

using reference::Decisions;
using Runs = std::vector<reference::Run>;

constexpr unsigned scans = 240;

// What a twin works on.
struct Given {
    reference::ScanPoints points;
    reference::NoiseOfScan noise;
    Runs segments;
    Runs runs;
};

Given given(const ale_extractor_t *e)
{
    return {scene::points_of(*e), scene::noise_of(*e), scene::segments_of(*e), scene::runs_of(e->runs)};
}

using Stage = std::function<void(ale_run_list_t *)>;
using Twin = std::function<Runs(const Given &, Decisions &)>;

// Leads simulated scans to a stage and compares the runs that it leaves, and the effort that it takes, with
// those of the twin. Returns how many scans the stage changed.
int compare_runs(unsigned seed, double share, const Stage &before, const Stage &stage, const Twin &twin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    scene::agreement agreement;
    int changed = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, seed);
        scene::search_runs(e, *scan);
        before(&e->runs);
        const Given input = given(e);
        Decisions decisions;
        const Runs expected = twin(input, decisions);
        const int effort_before = e->runs.effort;
        stage(&e->runs);
        const bool same_effort = e->runs.effort - effort_before == decisions.spent();
        agreement.compare(scene::runs_of(e->runs) == expected && same_effort, decisions, k);
        changed += expected == input.runs ? 0 : 1;
    }
    agreement.expect_differences_below(share);
    return changed;
}

TEST(Runs, TheSearchFindsThoseOfTheTwin)
{
    const auto nothing = [](ale_run_list_t *) {};
    const auto twin = [](const Given &g, Decisions &decisions) {
        return reference::search_segments(g.points, g.noise, g.segments, decisions).runs;
    };
    compare_runs(11, 0.02, nothing, ale_runs_search, twin);
}

TEST(Runs, BreaksArePlacedWhereTheTwinPlacesThem)
{
    const auto twin = [](const Given &g, Decisions &decisions) {
        return reference::placed_runs(g.points, g.noise, g.segments, g.runs, reference::wide_step, decisions);
    };
    EXPECT_GT(compare_runs(12, 0.03, ale_merge_runs, scene::place_runs, twin), 100);
}

// After merging alone, which leaves sharper steps and corners in runs than there are in the end.
TEST(Runs, LongRunsAreSplitAtTheStepsOfTheTwin)
{
    const auto twin = [](const Given &g, Decisions &decisions) {
        return reference::split_at_steps(g.points, g.noise, g.runs, decisions);
    };
    EXPECT_GT(compare_runs(14, 0.02, ale_merge_runs, ale_runs_split_at_steps, twin), 10);
}

// A search that skips places may miss the best one; the twin here tries them all. Where the lines meet a
// break may be a little worse than that.
TEST(Runs, NearlyNoBreakIsWorseThanTheBestOfAllByMoreThanAMeetingPointMayBe)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    int breaks = 0;
    int good = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 13);
        scene::search_runs(e, *scan);
        ale_merge_runs(&e->runs);
        const Given before = given(e);
        scene::place_runs(&e->runs);
        const Runs placed = scene::runs_of(e->runs);
        for (size_t i = 0; i + 1 < placed.size(); i++) {
            if (placed[i].last == before.runs[i].last && placed[i + 1].first == before.runs[i + 1].first) {
                continue;
            }
            const reference::BreakRange range = reference::range_between(
                before.points, before.runs[i], before.runs[i + 1], reference::wide_step);
            const reference::Run &a = before.runs[i];
            const reference::Run &b = before.runs[i + 1];
            const auto chi_at = [&](int split) {
                return reference::joint_chi(
                    before.points, {a.first, b.last}, split,
                    reference::fit_run(before.points, before.noise, a.first, a.last).var,
                    reference::fit_run(before.points, before.noise, b.first, b.last).var);
            };
            const int least =
                reference::best_break(before.points, before.noise, a, b, range.lowest, range.highest);
            breaks++;
            good += chi_at(placed[i].last) <= chi_at(least) + reference::meeting_loss ? 1 : 0;
        }
    }
    EXPECT_GT(breaks, 200);
    EXPECT_GE(good, 0.95 * breaks) << good << " of " << breaks;
}

// Rooms with all breaks unsettled, so that some ask for more than there is left.
TEST(Runs, BreaksAreThosePlacedAgainOfTheTwinAndTakeNoMoreEffortThanIsLeft)
{
    for (const int effort : {0, 700, 780, 820, ALE_MOST_EFFORT, ALE_MOST_EFFORT + 1}) {
        int most = 0;
        const auto before = [effort](ale_run_list_t *runs) {
            ale_merge_runs(runs);
            runs->effort = effort;
        };
        const auto place = [&](ale_run_list_t *runs) {
            ale_runs_place_again(runs, ALE_BREAK_WIDE_STEP);
            most = std::max(most, runs->effort);
        };
        const auto twin = [effort](const Given &g, Decisions &decisions) {
            const int step = reference::affordable_step(g.segments, g.runs, reference::wide_step,
                                                        reference::most_effort - effort);
            return step == 0 ? g.runs
                             : reference::placed_runs(g.points, g.noise, g.segments, g.runs, step, decisions);
        };
        compare_runs(18, 0.05, before, place, twin);
        EXPECT_LT(most, ALE_MOST_EFFORT * 5 / 4) << effort;
    }
}

// Walls that bend by 4 to 12 degrees two metres away, behind beam 49 to 68, 10 mm of noise: the joint chi
// square is nearly the same over many beams there.
TEST(Runs, ABendIsFoundNearerToItsPlaceThanTheBestJointFitIs)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    double placed_error = 0;
    double best_error = 0;
    for (int k = 0; k < 200; k++) {
        const int bend = 49 + k % 20;
        const double y = 2 * std::tan((bend + 0.5 - 60) * scene::urg_step);
        const double turn = (4 + k % 9) * scene::pi / 180;
        const auto scan = scene::empty_scan(120, -60 * scene::urg_step);
        scene::see(*scan, {{2, -2, 2, y}, {2, y, 2 - 2 * std::sin(turn), y + 2 * std::cos(turn)}}, 10,
                   static_cast<unsigned>(k));
        scene::prepare_points(e, *scan);
        scene::set_runs(&e->runs, {{0, bend + 9}, {bend + 10, e->runs.scan.points.count - 1}});
        const Given before = given(e);
        scene::place_runs(&e->runs);
        const reference::Run &a = before.runs[0];
        const reference::Run &b = before.runs[1];
        const reference::BreakRange range =
            reference::range_between(before.points, a, b, reference::wide_step);
        const int best =
            reference::best_break(before.points, before.noise, a, b, range.lowest, range.highest);
        placed_error += std::pow(e->runs.scan.points.beam[e->runs.run[0].last] - bend, 2);
        best_error += std::pow(e->runs.scan.points.beam[best] - bend, 2);
    }
    EXPECT_LT(placed_error, best_error / 2) << "squared beams, " << best_error;
}

TEST(Runs, TheOuterPointsThatARunGivesUpAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    scene::agreement agreement;
    int trimmed = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 17);
        scene::search_runs(e, *scan);
        const Given g = given(e);
        for (int i = 0; i < e->runs.count; i++) {
            Decisions decisions;
            const reference::Run &run = g.runs[static_cast<size_t>(i)];
            const reference::Run expected =
                reference::trimmed_run(g.points, g.noise, run, e->config.min_points, decisions);
            ale_run_trim(&e->runs, &e->runs.run[i]);
            agreement.compare(scene::runs_of(e->runs)[static_cast<size_t>(i)] == expected, decisions, k);
            trimmed += expected == run ? 0 : 1;
        }
    }
    agreement.expect_differences_below(0.01);
    EXPECT_GT(trimmed, 100);
}

TEST(Runs, BreaksThatTheSearchMissedAreFoundWhereTheTwinFindsThem)
{
    // every second run is joined to the next one, so that there is something to find, and loses some points
    // at its ends, so that there is something to take in
    const auto join = [](ale_run_list_t *list) {
        Runs joined;
        const Runs runs = scene::runs_of(*list);
        for (size_t k = 0; k < runs.size(); k += 2) {
            const reference::Run &next = runs[std::min(k + 1, runs.size() - 1)];
            const int lost = next.last - runs[k].first > 20 ? static_cast<int>(k) % 6 : 0;
            joined.push_back({runs[k].first + lost, next.last - lost});
        }
        scene::set_runs(list, joined);
    };
    const auto twin = [](const Given &g, Decisions &decisions) {
        return reference::split_runs(g.points, g.noise, g.segments, g.runs, decisions);
    };
    EXPECT_GT(compare_runs(14, 0.05, join, ale_runs_split, twin), 200);
}

TEST(Merge, RunsAreJoinedAsTheTwinJoinsThem)
{
    // every run is cut in two, so that there is something to join
    const auto halve = [](ale_run_list_t *runs) {
        Runs halves;
        for (const reference::Run &run : scene::runs_of(*runs)) {
            const int middle = (run.first + run.last) / 2;
            halves.push_back({run.first, middle});
            halves.push_back({middle + 1, run.last});
        }
        scene::set_runs(runs, halves);
    };
    const auto twin = [](const Given &g, Decisions &decisions) {
        return reference::merged_runs(g.points, g.noise, g.segments, g.runs, decisions);
    };
    EXPECT_GT(compare_runs(15, 0.02, halve, ale_merge_runs, twin), 200);
}

TEST(Curve, CurvesAreThoseOfTheTwin)
{
    const auto straight = [](ale_run_list_t *runs) {
        ale_merge_runs(runs);
        scene::place_runs(runs);
    };
    for (const bool again : {false, true}) {
        const auto find = [again](ale_run_list_t *runs) { ale_curve_find(runs, again); };
        const auto twin = [again](const Given &g, Decisions &decisions) {
            return reference::with_curves(g.points, g.noise, g.segments, g.runs, again, decisions);
        };
        EXPECT_GT(compare_runs(16, 0.02, straight, find, twin), 15) << again;
    }
}

// Edge cases: nothing, one point, the fewest points of a run, all ranges equal.
TEST(Runs, OfVeryFewPointsAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    for (const int points : {0, 1, 4, 5, 6, 9}) {
        const auto scan = scene::empty_scan(20);
        for (int k = 0; k < points; k++) {
            ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), 1000000);
        }
        scene::prepare_points(e, *scan);
        ale_runs_search(&e->runs);
        const Given g = given(e);
        Decisions decisions;
        Runs expected;
        if (!g.points.empty()) {
            expected = reference::search_segments(g.points, g.noise, g.segments, decisions).runs;
        }
        EXPECT_EQ(scene::runs_of(e->runs), expected) << points;
    }
}

} // namespace
