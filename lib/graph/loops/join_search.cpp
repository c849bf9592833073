#include "graph/loops/join_search.h"

#include <algorithm>
#include <functional>
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

// Queries while driving: how many at least and at most, and how far apart.
struct Queries {
    size_t least;
    size_t most;
    int stride;     // of nodes along the path
    double apart_m; // along it
};
constexpr Queries predicted{4, 4, 2, 0};
// Where wheels say nothing of the place a join needs far more.
constexpr Queries unpredicted{JoinDecision::least_elsewhere, JoinSearch::most_queries, 1, 1.0};
// How far apart places are, so that every one of a robot in that map is well within PlaceSearch::half_m: in a
// saved map a view is half a step of the grid from it at most.
constexpr double nodes_apart_m = 2.0;
constexpr double views_apart_m = PlaceSearch::half_m - PriorViews::apart_m / 2;
constexpr size_t most_of_a_map = 32; // queries after the drive
// Queries with places after a drive: one on which the robot was lost again and again is in hundreds of maps,
// of some nodes each.
constexpr size_t most_pairs = 40000;
constexpr double least_part = 0.5; // of the points in view that must lie on surfaces
constexpr double least_in_view = 1.0 / 3;
constexpr double least_agreed = 0.85; // as of loops
// Matches nearer than this say the same.
constexpr double same_m = 0.30;

using NodesOfMaps = std::map<uint32_t, std::vector<int>>;

// Every node, or every second, third.. of each map that may join another.
NodesOfMaps queries_of_maps(const std::vector<Node> &nodes)
{
    NodesOfMaps all;
    for (int k = 0; k < static_cast<int>(nodes.size()); k++) {
        all[at(nodes, k).map_id].push_back(k);
    }
    NodesOfMaps some;
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

// How many nodes each map has. None is larger than one of views: these cannot be searched for.
std::map<uint32_t, size_t> sizes_of(const SearchedMaps &maps)
{
    std::map<uint32_t, size_t> sizes;
    for (const Node &node : maps.nodes) {
        sizes[node.map_id]++;
    }
    if (maps.first() < 0) {
        sizes[maps.map_of(maps.first())] = maps.nodes.size() + 1;
    }
    return sizes;
}

// Whether there is a saved map that the robot was never in.
bool begins_lost(const SearchedMaps &maps)
{
    return maps.first() < 0 && std::none_of(maps.nodes.begin(), maps.nodes.end(),
                                            [](const Node &node) { return node.map_id == ALE_FIRST_MAP; });
}

// The last nodes of the present map.
std::vector<int> last_along_path(const std::vector<Node> &nodes, const Queries &wanted)
{
    std::vector<int> chosen;
    int of_map = 0;
    for (int k = static_cast<int>(nodes.size()) - 1; k >= 0 && chosen.size() < wanted.most; k--) {
        const bool is_query = at(nodes, k).map_id == nodes.back().map_id && of_map++ % wanted.stride == 0;
        const double from_last_m =
            chosen.empty() ? wanted.apart_m : at(nodes, chosen.back()).path_m - at(nodes, k).path_m;
        if (is_query && from_last_m >= wanted.apart_m) {
            chosen.push_back(k);
        }
    }
    return chosen.size() < wanted.least ? std::vector<int>() : chosen;
}

// Nodes and views of a map, such that each other of it is within reach of a search about one. O(n^2).
std::vector<int> spread_places(const SearchedMaps &maps, uint32_t map_id)
{
    std::vector<int> chosen;
    for (int k = maps.first(); k < maps.end(); k++) {
        const double apart_m = k < 0 ? views_apart_m : nodes_apart_m;
        const Pose &here = maps.pose_of(k);
        const auto covers = [&](int other) {
            const Pose &there = maps.pose_of(other);
            return length(here.x - there.x, here.y - there.y) < apart_m;
        };
        if (maps.map_of(k) == map_id && std::none_of(chosen.begin(), chosen.end(), covers)) {
            chosen.push_back(k);
        }
    }
    return chosen;
}

// The largest maps, as many as can be searched in each other with most_pairs, and never fewer than the robot
// may have at once.
std::map<uint32_t, size_t> largest_of(const std::map<uint32_t, size_t> &sizes, const NodesOfMaps &queries,
                                      const NodesOfMaps &places)
{
    std::set<std::pair<size_t, uint32_t>, std::greater<>> largest_first;
    for (const auto &[map_id, size] : sizes) {
        largest_first.emplace(size, map_id);
    }
    std::map<uint32_t, size_t> largest;
    size_t pairs = 0;
    size_t larger_places = 0;
    for (const auto &[size, map_id] : largest_first) {
        const auto of_map = queries.find(map_id);
        pairs += of_map == queries.end() ? 0 : of_map->second.size() * larger_places;
        if (pairs > most_pairs && largest.size() >= ALE_ATLAS_MAPS) {
            break;
        }
        larger_places += places.at(map_id).size();
        largest.emplace(map_id, size);
    }
    return largest;
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

std::vector<JoinTask> tasks_while_driving(const SearchedMaps &maps, const std::vector<uint32_t> &left_out)
{
    const std::vector<int> queries = last_along_path(maps.nodes, begins_lost(maps) ? unpredicted : predicted);
    std::set<uint32_t> others;
    for (int k = maps.first(); k < maps.end(); k++) {
        const uint32_t map_id = maps.map_of(k);
        if (map_id != maps.nodes.back().map_id &&
            std::find(left_out.begin(), left_out.end(), map_id) == left_out.end()) {
            others.insert(map_id);
        }
    }
    std::vector<JoinTask> tasks;
    for (const uint32_t map_id : others) {
        for (const int place : spread_places(maps, map_id)) {
            add_tasks(place, queries, &tasks);
        }
    }
    return tasks;
}

std::vector<JoinTask> tasks_after_drive(const SearchedMaps &maps, MapKind kind)
{
    const NodesOfMaps queries = queries_of_maps(maps.nodes);
    std::map<uint32_t, size_t> sizes = sizes_of(maps);
    NodesOfMaps places;
    for (const auto &[map_id, size] : sizes) {
        places[map_id] = spread_places(maps, map_id);
    }
    if (kind != MapKind::drives) {
        sizes = largest_of(sizes, queries, places);
    }
    std::vector<JoinTask> tasks;
    for (const auto &[there, size] : sizes) {
        std::vector<int> smaller;
        for (const auto &[here, of_map] : queries) {
            const auto own = sizes.find(here);
            if (own != sizes.end() && std::make_pair(own->second, here) < std::make_pair(size, there)) {
                smaller.insert(smaller.end(), of_map.begin(), of_map.end());
            }
        }
        for (const int place : places[there]) {
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

bool JoinSearch::step(const SearchedMaps &maps)
{
    if (next_ < tasks_.size()) {
        search(maps, tasks_[next_]);
        next_++;
    }
    return next_ < tasks_.size();
}

void JoinSearch::search(const SearchedMaps &maps, const JoinTask &task)
{
    if (task.queries.empty()) {
        return;
    }
    const Place place(maps, task.place);
    const PlaceSearch in_place(place);
    for (const int query : task.queries) {
        const View view(maps.nodes, maps.poses, query);
        for (const LoopMatch &match : in_place.find(view.points)) {
            if (match.overlap < least_part * least_in_view) {
                continue;
            }
            const Explanation seen = place.explain(view, match.pose);
            if (seen.agreed >= least_agreed &&
                match.overlap >= least_part * std::max(least_in_view, seen.in_view)) {
                keep(maps, loop_from_match(match, task.place, query));
            }
        }
    }
}

// Of matches that put a node to the same place the best; of all with one map the best few.
void JoinSearch::keep(const SearchedMaps &maps, const Loop &match)
{
    const auto put = [&](const Loop &loop) { return compose(maps.pose_of(loop.from), loop.measured); };
    size_t with_map = 0;
    size_t worst = matches_.size();
    for (size_t k = 0; k < matches_.size(); k++) {
        Loop &other = matches_[k];
        if (other.to != match.to || maps.map_of(other.from) != maps.map_of(match.from)) {
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

std::optional<FoundJoin> JoinSearch::decide(const SearchedMaps &maps, MapKind kind) const
{
    std::vector<int> compared = queries_;
    if (kind == MapKind::drives) {
        compared.resize(maps.nodes.size());
        std::iota(compared.begin(), compared.end(), 0);
    }
    return JoinDecision(maps, matches_, std::move(compared), kind).find();
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
