// Closes loops: nodes in, corrected poses out.
//
//   LoopCloser closer(capacity);
//   if (closer.add(node, motion)) { ... closer.poses() have moved ... }
//
// A loop is accepted if the match is clear (overlap, no other place nearly as good) and loops from other
// nodes confirm it; it is rejected again if the graph then contradicts it. Where the tracker has recognised
// the place itself nothing is corrected: the edge records the pose as tracked, so that later corrections keep
// it. Memory is bounded: a full graph removes the most redundant node (thinning.h) for each new one.
//
// Nodes may be of several maps that nothing ties yet. Each is treated by itself: loops, building direction
// and prior map (that of the first map) concern the present one alone, and the others stay as they are.
//
// Not thread-safe. Whatever adds or refines may throw std::bad_alloc; reset() is then the only valid call.
#ifndef ALE_GRAPH_LOOPS_LOOP_CLOSER_H
#define ALE_GRAPH_LOOPS_LOOP_CLOSER_H

#include <deque>
#include <optional>
#include <vector>

#include "graph/loops/loop.h"
#include "graph/loops/loop_match.h"
#include "graph/loops/loop_search.h"
#include "graph/loops/map_joiner.h"
#include "graph/loops/map_table.h"
#include "graph/loops/neighbour_matches.h"
#include "graph/loops/odometry.h"
#include "graph/loops/pairwise_refinement.h"
#include "graph/loops/prior_map.h"
#include "graph/loops/visit_match.h"
#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

struct LoopStatistics {
    uint32_t candidates;   // places matched
    uint32_t recognised;   // the tracker has recognised the place itself
    uint32_t unclear;      // too little overlap, or another place nearly as good
    uint32_t unconfirmed;  // too few other nodes agreed
    uint32_t contradicted; // rejected after optimisation
    uint32_t loops;        // accepted
    uint32_t straightened; // corrections by the building direction
    uint32_t thinned;      // nodes removed for others
    uint32_t joins;        // of maps
};

class LoopCloser
{
  public:
    static constexpr size_t least_capacity = 64; // so that the present visit is whole

    // Holds at most `capacity` nodes, least_capacity at least; allocates the graph for them.
    explicit LoopCloser(size_t capacity);

    // The drive begins in this map: nodes are matched with its walls, which stay where they are. Before the
    // first node; reset() forgets it. O(walls).
    void set_prior_map(const ale_map_t &map)
    {
        prior_.emplace(map);
    }

    // The same for a map of tiles, of which parts come and go.
    void change_tiles(const ale_tile_change_t &change)
    {
        if (!prior_) {
            prior_.emplace(ale_map_t{});
        }
        prior_->change(change);
        joiner_.restart();
    }

    // Adds a node and searches for loops. `motion`: the node's pose as seen from the node before; of the
    // first one its pose in the map. True: earlier poses have moved. Work: three searches by match_submap,
    // two pairwise matches, one match with the prior map, 30 iterations of the graph; with several maps one
    // place of others besides (MapJoiner).
    bool add(Node node, const Pose &motion);

    // Adds a node of a drive that is over, one of several perhaps: loops are looked for by refine(). All
    // nodes come this way or by add(), and as many as there are: none is removed. O(1).
    void append(Node node, const Pose &motion);
    // That of refine() which joins maps, alone. Called after each of many drives, it spares the search of all
    // in all. What it joins is added to `made`, if that is not null.
    bool join_maps(std::vector<FoundJoin> *made = nullptr);
    // Makes a join that was found before, in another graph of the same nodes: its nodes move, loops hold
    // them. Ten iterations of the graph.
    void make_join(const FoundJoin &found);

    // A map has become part of another: its nodes move with it, here and as tracked. Before the node at
    // `here` is added, in which the tracker has recognised a place of the other map: it ties them. Maps that
    // have not joined another; O(nodes).
    void join(const MapJoin &join, const Pose &here);
    // A join that was found here; none while nothing speaks for one. It waits until it is made, and no other
    // is looked for.
    const std::optional<FoundJoin> &found_join() const
    {
        return joiner_.found();
    }
    // Makes it: its nodes move, loops hold them. Ten iterations of the graph.
    void make_found_join();
    // The tracker was handed the found join, as a correction that moves its map. O(nodes); never throws.
    void mark_join_handed_out();
    // The join that was handed out is void. O(nodes); never throws.
    void withdraw_join();
    // The join that was found, if it was not handed out, is looked for anew.
    void forget_found_join()
    {
        joiner_.forget_found();
    }
    // What has become of other maps is not known: see MapJoiner.
    void lose_track_of_maps(uint32_t present)
    {
        joiner_.lose_track(nodes_, present);
    }
    // The map that this one is part of now. O(1).
    uint32_t map_now(uint32_t map_id) const
    {
        return maps_.now(map_id);
    }

    // Adds the walls of a scan after the last node, robot's frame, for the building direction in refine();
    // `smooth` as the nodes' own. Scans beyond most_later_scans a node are ignored. O(walls).
    void add_walls(const Pose &smooth, const std::vector<WallDirection> &walls);

    // Searches for loops again and refines all poses, a bounded piece of the work a call; poses() move with
    // the last. False: nothing is left to do until a node is added.
    bool refine();

    const std::vector<Node> &nodes() const
    {
        return nodes_;
    }
    // Map frame, one for each node.
    const std::vector<Pose> &poses() const
    {
        return graph_.poses();
    }
    // Of the path and of loops.
    const std::vector<GraphEdge> &edges() const
    {
        return graph_.edges();
    }
    // The tracker was handed all poses as they are now. O(nodes); never throws.
    void mark_handed_out();
    // As after the constructor; allocates nothing, never throws.
    void reset();
    const LoopStatistics &statistics() const
    {
        return statistics_;
    }

  private:
    void make_room();
    void link_to_previous(const Pose &motion);
    BuildingConstraint building() const;
    bool tie_joined_map();
    std::vector<bool> removable_nodes() const;
    std::vector<bool> nodes_outside(uint32_t map_id) const;
    uint32_t present_map() const
    {
        return nodes_.back().map_id;
    }
    bool evaluate_candidate(int candidate);
    std::vector<Loop> confirmations_of(const Loop &loop) const;
    size_t confirmations_needed(const Loop &loop) const;
    bool close_loop(const Loop &loop, const std::vector<Loop> &confirmations);
    bool straighten();
    bool match_prior_map();
    SearchedMaps searched_maps();
    bool optimise();
    GraphReport optimise_map(uint32_t map_id);
    void unite(const MapJoin &join);
    void move_tracked(uint32_t map_id, const Pose &shift);
    bool is_in_graph(const Loop &loop) const;

    size_t capacity_;
    std::vector<Node> nodes_; // along the path
    PoseGraph graph_;
    std::optional<PriorMap> prior_;
    std::deque<Loop> pending_; // wait for confirmation
    NeighbourMatches neighbours_;
    Pace pace_;
    MapTable maps_;
    MapJoiner joiner_;
    std::optional<Visit> joined_at_; // of an older map: there the next node joins that
    size_t added_ = 0;               // nodes, ever
    size_t straightened_at_ = 0;     // how many had been added then
    int iterations_left_ = 0;        // of those that the present node may cause
    std::optional<LoopSearch> search_;
    std::optional<PairwiseRefinement> refinement_;
    bool refined_ = false; // nothing was added since
    MapKind kind_ = MapKind::pieces;
    LoopStatistics statistics_{};
};

} // namespace ale

#endif
