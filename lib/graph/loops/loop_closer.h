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
// Not thread-safe. Whatever adds or refines may throw std::bad_alloc; reset() is then the only valid call.
#ifndef ALE_GRAPH_LOOPS_LOOP_CLOSER_H
#define ALE_GRAPH_LOOPS_LOOP_CLOSER_H

#include <deque>
#include <optional>
#include <vector>

#include "graph/loops/loop.h"
#include "graph/loops/loop_match.h"
#include "graph/loops/loop_search.h"
#include "graph/loops/pairwise_refinement.h"
#include "graph/loops/prior_map.h"
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
};

class LoopCloser
{
  public:
    static constexpr size_t least_capacity = 64; // so that the present visit is whole
    static constexpr int most_later_scans = 16;

    // Holds at most `capacity` nodes, least_capacity at least; allocates the graph for them.
    explicit LoopCloser(size_t capacity);

    // The drive begins in this map: nodes are matched with its walls, which stay where they are. Before the
    // first node; reset() forgets it. O(walls).
    void set_prior_map(const ale_map_t &map)
    {
        prior_.emplace(map);
    }

    // Adds a node and searches for loops. `motion`: the node's pose as seen from the node before; of the
    // first one its pose in the map. True: earlier poses have moved. Work: three searches by match_submap,
    // two pairwise matches, one match with the prior map, 30 iterations of the graph.
    bool add(Node node, const Pose &motion);

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
    // The tracker was handed all poses as they are now. O(nodes); never throws.
    void mark_handed_out();
    // As after the constructor; allocates nothing, never throws.
    void reset();
    const LoopStatistics &statistics() const
    {
        return statistics_;
    }

  private:
    enum class MatchOutcome { unclear, recognised, displaced };
    // Two neighbours along the path, matched pairwise: independent of drift.
    struct NeighbourMatch {
        GraphEdge match;
        double misfit; // of the poses as tracked
    };

    void make_room();
    void link_to_previous(const Pose &motion);
    void match_neighbours();
    bool neighbours_contradict_building() const;
    std::vector<int> candidates() const;
    bool evaluate_candidate(int candidate);
    MatchOutcome match_candidate(int candidate, Loop *loop) const;
    std::vector<Loop> confirmations_of(const Loop &loop) const;
    size_t confirmations_needed(const Loop &loop) const;
    bool close_loop(const Loop &loop, const std::vector<Loop> &confirmations);
    bool straighten();
    bool match_prior_map();
    bool optimise();
    bool is_in_graph(const Loop &loop) const;

    size_t capacity_;
    std::vector<Node> nodes_; // along the path
    PoseGraph graph_;
    std::optional<PriorMap> prior_;
    std::deque<Loop> pending_;               // wait for confirmation
    std::vector<NeighbourMatch> neighbours_; // along the path
    size_t added_ = 0;                       // nodes, ever
    size_t straightened_at_ = 0;             // how many had been added then
    int iterations_left_ = 0;                // of those that the present node may cause
    std::optional<LoopSearch> search_;
    std::optional<PairwiseRefinement> refinement_;
    bool refined_ = false; // nothing was added since
    LoopStatistics statistics_{};
};

} // namespace ale

#endif
