// Looks for the place of a map in others: a bounded piece of the work with every node while driving, and all
// of it after the drive.
//
//   joiner.drive(maps);                         (with every node)
//   if (joiner.found()) ... joiner.found()->join ... joiner.forget_found();
//
// While driving the last nodes of the present map are searched in all places of the others, some places with
// each node; when all have been seen, the matches decide, and the next sweep begins. After the drive all maps
// are searched in all others, until nothing joins. Whatever searches may throw std::bad_alloc.
#ifndef ALE_GRAPH_LOOPS_MAP_JOINER_H
#define ALE_GRAPH_LOOPS_MAP_JOINER_H

#include <cstdint>
#include <optional>
#include <vector>

#include "graph/loops/join_search.h"

namespace ale
{

class MapJoiner
{
  public:
    static constexpr int places_a_node = 2;

    // After a node was added. Work: places_a_node steps of a JoinSearch, or its decision. Nothing while a
    // found join waits. O(nodes) if there is one map.
    void drive(const SearchedMaps &maps);

    // One step of the search after the drive, see JoinSearch. False: nothing is left to join.
    bool refine(const SearchedMaps &maps, MapKind kind);

    // A join that may be made.
    const std::optional<FoundJoin> &found() const
    {
        return found_;
    }
    // It is made, or has become void. The search goes on with the maps as they are then.
    void forget_found()
    {
        found_.reset();
    }

    // What became of other maps than the present and the first is not known: while driving they are left
    // alone until the robot is in them.
    void lose_track(const std::vector<Node> &nodes, uint32_t present);

    // Maps have changed: the search begins anew.
    void restart();
    // Node k is no more: see JoinSearch.
    void remove_node(int k);
    void reset();

  private:
    std::optional<JoinSearch> search_;
    std::optional<FoundJoin> found_;
    std::vector<uint32_t> unknown_; // maps
    uint32_t present_ = 0;          // that the search while driving is of
    bool driving_ = true;
    int rounds_ = 0;      // after the drive
    bool joined_ = false; // in this round
};

} // namespace ale

#endif
