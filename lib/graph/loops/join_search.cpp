#include "graph/loops/join_search.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "graph/loops/place.h"
#include "graph/loops/place_search.h"

namespace ale
{

namespace
{

constexpr double places_apart_m = 2.0; // so that every node of a map is well within PlaceSearch::half_m
constexpr int queries_while_driving = 4;
constexpr int query_stride = 2;      // of nodes along the path
constexpr size_t most_of_a_map = 32; // queries after the drive
constexpr double least_part = 0.5;   // of the points in view that must lie on surfaces
constexpr double least_in_view = 1.0 / 3;
constexpr double least_agreed = 0.85; // as of loops
// Matches nearer than this say the same.
constexpr double same_m = 0.30;

using Queries = std::map<uint32_t, std::vector<int>>;

// Every node, or every second, third.. of each map that may join another.
Queries queries_of_maps(const std::vector<Node> &nodes)
{
    Queries all;
    for (int k = 0; k < static_cast<int>(nodes.size()); k++) {
        all[at(nodes, k).map_id].push_back(k);
    }
    Queries some;
    for (const auto &[map_id, of_map] : all) {
        if (of_map.size() < JoinDecision::least_nodes) {
            continue;
        }
        const size_t stride = 1 + (of_map.size() - 1) / most_of_a_map;
        for (size_t k = 0; k < of_map.size(); k += stride) {
            some[map_id].push_back(of_map[k]);
        }
    }
    return some;
}

void add_tasks(int place, const std::vector<int> &queries, std::vector<JoinTask> *tasks)
{
    for (size_t k = 0; k < queries.size(); k += JoinSearch::most_queries) {
        const size_t last = std::min(queries.size(), k + JoinSearch::most_queries);
        tasks->push_back({place,
                          {queries.begin() + static_cast<std::ptrdiff_t>(k),
                           queries.begin() + static_cast<std::ptrdiff_t>(last)}});
    }
}

} // namespace

std::vector<JoinTask> tasks_while_driving(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                          const std::vector<uint32_t> &left_out)
{
    const uint32_t present = nodes.back().map_id;
    std::vector<int> queries;
    int of_map = 0;
    for (int k = static_cast<int>(nodes.size()) - 1; k >= 0; k--) {
        const bool is_query = at(nodes, k).map_id == present && of_map++ % query_stride == 0;
        if (is_query && queries.size() < queries_while_driving) {
            queries.push_back(k);
        }
    }
    std::set<uint32_t> others;
    for (const Node &node : nodes) {
        if (node.map_id != present &&
            std::find(left_out.begin(), left_out.end(), node.map_id) == left_out.end()) {
            others.insert(node.map_id);
        }
    }
    std::vector<JoinTask> tasks;
    for (const uint32_t map_id : others) {
        for (const int place : spread_nodes(nodes, poses, map_id, places_apart_m)) {
            add_tasks(place, queries, &tasks);
        }
    }
    return queries.size() < queries_while_driving ? std::vector<JoinTask>() : tasks;
}

std::vector<JoinTask> tasks_after_drive(const std::vector<Node> &nodes, const std::vector<Pose> &poses)
{
    std::map<uint32_t, size_t> sizes;
    for (const Node &node : nodes) {
        sizes[node.map_id]++;
    }
    std::vector<JoinTask> tasks;
    const Queries queries = queries_of_maps(nodes);
    for (const auto &[there, size] : sizes) {
        std::vector<int> smaller;
        for (const auto &[here, of_map] : queries) {
            if (std::make_pair(sizes[here], here) < std::make_pair(size, there)) {
                smaller.insert(smaller.end(), of_map.begin(), of_map.end());
            }
        }
        for (const int place : spread_nodes(nodes, poses, there, places_apart_m)) {
            add_tasks(place, smaller, &tasks);
        }
    }
    return tasks;
}

JoinSearch::JoinSearch(std::vector<JoinTask> tasks) : tasks_(std::move(tasks))
{
    std::set<int> queries;
    for (const JoinTask &task : tasks_) {
        queries.insert(task.queries.begin(), task.queries.end());
    }
    queries_.assign(queries.begin(), queries.end());
}

bool JoinSearch::step(const std::vector<Node> &nodes, const std::vector<Pose> &poses)
{
    if (next_ < tasks_.size()) {
        search(nodes, poses, tasks_[next_]);
        next_++;
    }
    return next_ < tasks_.size();
}

void JoinSearch::search(const std::vector<Node> &nodes, const std::vector<Pose> &poses, const JoinTask &task)
{
    if (task.queries.empty()) {
        return;
    }
    const Place place(nodes, poses, task.place);
    const PlaceSearch in_place(place);
    for (const int query : task.queries) {
        const View view(nodes, poses, query);
        for (const LoopMatch &match : in_place.find(view.points)) {
            if (match.overlap < least_part * least_in_view) {
                continue;
            }
            const Explanation seen = place.explain(view, match.pose);
            if (seen.agreed >= least_agreed &&
                match.overlap >= least_part * std::max(least_in_view, seen.in_view)) {
                keep(nodes, poses, loop_from_match(match, task.place, query));
            }
        }
    }
}

// Of matches that put a node to the same place the best; of all with one map the best few.
void JoinSearch::keep(const std::vector<Node> &nodes, const std::vector<Pose> &poses, const Loop &match)
{
    const auto put = [&](const Loop &loop) { return compose(at(poses, loop.from), loop.measured); };
    size_t with_map = 0;
    size_t worst = matches_.size();
    for (size_t k = 0; k < matches_.size(); k++) {
        Loop &other = matches_[k];
        if (other.to != match.to || at(nodes, other.from).map_id != at(nodes, match.from).map_id) {
            continue;
        }
        const Pose off = between(put(other), put(match));
        if (length(off.x, off.y) < same_m && std::abs(off.theta) < same_m) {
            other = match.overlap > other.overlap ? match : other;
            return;
        }
        with_map++;
        worst = worst == matches_.size() || other.overlap < matches_[worst].overlap ? k : worst;
    }
    if (with_map < most_matches) {
        matches_.push_back(match);
    } else if (match.overlap > matches_[worst].overlap) {
        matches_[worst] = match;
    }
}

std::optional<FoundJoin> JoinSearch::decide(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                            MapKind kind) const
{
    std::vector<int> compared = queries_;
    if (kind == MapKind::drives) {
        compared.resize(nodes.size());
        std::iota(compared.begin(), compared.end(), 0);
    }
    return JoinDecision(nodes, poses, matches_, std::move(compared), kind).find();
}

void JoinSearch::remove_node(int k)
{
    const auto move_up = [k](int *node) { *node -= *node > k ? 1 : 0; };
    const auto clean = [&](std::vector<int> *nodes) {
        nodes->erase(std::remove(nodes->begin(), nodes->end(), k), nodes->end());
        std::for_each(nodes->begin(), nodes->end(), [&](int &node) { move_up(&node); });
    };
    clean(&queries_);
    for (JoinTask &task : tasks_) {
        clean(&task.queries);
        if (task.place == k) {
            task.queries.clear();
            task.place = 0;
        }
        move_up(&task.place);
    }
    const auto refers = [k](const Loop &loop) { return loop.from == k || loop.to == k; };
    matches_.erase(std::remove_if(matches_.begin(), matches_.end(), refers), matches_.end());
    for (Loop &loop : matches_) {
        move_up(&loop.from);
        move_up(&loop.to);
    }
}

} // namespace ale
