// Searches for a map in all others: nodes of the one are matched with places of the others, whatever the
// heading, a place a step; then the matches decide (join_decision.h).
//
//   JoinSearch search(tasks);
//   while (search.step(maps)) {
//   }
//   if (const auto found = search.decide(maps)) ... found->join ...
//
// Nodes may be added between the steps, and removed if remove_node() is told.
#ifndef ALE_GRAPH_LOOPS_JOIN_SEARCH_H
#define ALE_GRAPH_LOOPS_JOIN_SEARCH_H

#include <optional>
#include <vector>

#include "graph/loops/join_decision.h"
#include "graph/optimise/node.h"

namespace ale
{

// A place of one map (a node or view), and the nodes of others that are searched there.
struct JoinTask {
    int place;
    std::vector<int> queries;
};

// The last nodes of the present map, searched in all other maps but those left out: four, or 16 if the robot
// was never in the saved map that the drive began in.
std::vector<JoinTask> tasks_while_driving(const SearchedMaps &maps, const std::vector<uint32_t> &left_out);
// Nodes of every map, searched in all others. Of two maps that with fewer nodes is searched for,
// and never one that there are views of. Of pieces of one way that are too many the smallest are left out:
// their places are as wheels have put them. O(nodes^2).
std::vector<JoinTask> tasks_after_drive(const SearchedMaps &maps, MapKind kind);

class JoinSearch
{
  public:
    // Of a task that is searched in one step; tasks have no more.
    static constexpr size_t most_queries = 16;
    // Matches that are kept of a node with a map, the best: bounds memory to 1.2 kB a query and map.
    static constexpr size_t most_matches = 8;

    explicit JoinSearch(std::vector<JoinTask> tasks);

    // One place: a PlaceSearch and its find() for each query. False: nothing is left. May throw
    // std::bad_alloc.
    bool step(const SearchedMaps &maps);

    // See JoinDecision::find.
    std::optional<FoundJoin> decide(const SearchedMaps &maps, MapKind kind) const;

    // Node k is no more: what refers to it goes, later nodes move down by one. O(tasks + matches).
    void remove_node(int k);

  private:
    void search(const SearchedMaps &maps, const JoinTask &task);
    void keep(const SearchedMaps &maps, const Loop &match);

    std::vector<JoinTask> tasks_;
    std::vector<int> queries_; // of all tasks
    std::vector<Loop> matches_;
    size_t next_ = 0;
};

} // namespace ale

#endif
