// Closes loops: nodes in, corrected poses out.
//
//   LoopCloser closer;
//   if (closer.add(node)) { ... closer.poses() have moved ... }
//
// A loop is believed only when matching finds the place clearly (overlap, no second place nearly as good),
// and other nodes nearby find the same shift; it is taken back when the graph then contradicts it. Where the
// tracker has recognised the place itself nothing is to be corrected: the tie is noted as the tracker knows
// it, so that later corrections keep it. Work of one call: at most loop_candidates matches and two of
// neighbours, and 30 iterations of the graph, however many loops are tried.
//
// Memory is bounded: when it holds as many nodes as it may, the next one takes the place of the most
// redundant (thinning.h), whose ties go over to its neighbours on the way.
#ifndef ALE_GRAPH_LOOPS_LOOP_CLOSER_H
#define ALE_GRAPH_LOOPS_LOOP_CLOSER_H

#include <deque>
#include <optional>
#include <vector>

#include "graph/loops/known_map.h"
#include "graph/loops/loop.h"
#include "graph/loops/loop_match.h"
#include "graph/loops/loop_search.h"
#include "graph/loops/refinement.h"
#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

struct LoopStatistics {
    uint32_t candidates;   // places looked at
    uint32_t known;        // the tracker has recognised the place itself: nothing to correct
    uint32_t unclear;      // too little overlap, or a second place nearly as good
    uint32_t unconfirmed;  // too few other nodes agreed
    uint32_t contradicted; // taken back after optimisation
    uint32_t loops;        // believed
    uint32_t straightened; // headings had drifted from the directions of the walls
    uint32_t thinned;      // nodes that made room for others
};

class LoopCloser
{
  public:
    // At most so many nodes are kept: at least least_capacity, so that the present visit is whole.
    explicit LoopCloser(size_t capacity);
    static constexpr size_t least_capacity = 64;

    // The map that the drive begins in, before the first node: nodes are laid on its walls, and it stays
    // where it is. begin_anew() forgets it.
    void know(const ale_map_t &map)
    {
        known_.emplace(map);
    }

    // `motion` is the node's pose as seen from the node before; of the first one its pose in the map. True
    // when earlier poses moved.
    bool add(Node node, const Pose &motion);

    // Walls that a scan after the last node saw, `smooth` as the nodes' own: a compass for refine(). Of so
    // many scans a node at most.
    void see_walls(const Pose &smooth, const std::vector<WallSight> &walls);
    static constexpr int most_scans_after = 16;

    // Looks for loops once more and draws all poses tighter by matching neighbours anew, a bounded piece a
    // call; poses() move with the last. False: nothing is left to do until a node is added.
    bool refine();

    const std::vector<Node> &nodes() const
    {
        return nodes_;
    }
    // The tracker was told where all nodes are.
    void told();
    // As after the constructor; allocates nothing.
    void begin_anew();
    const std::vector<Pose> &poses() const
    {
        return graph_.poses();
    }
    const LoopStatistics &statistics() const
    {
        return statistics_;
    }

  private:
    enum class Sight { unclear, known, displaced };
    // Two nodes of the way that show the same, matched tightly: drift plays no part in it.
    struct Neighbours {
        GraphEdge match;
        double misfit; // as the tracker has placed the two
    };

    void make_room();
    void link_to_previous(const Pose &motion);
    void match_neighbours();
    bool are_neighbours_torn() const;
    std::vector<int> candidates() const;
    bool look_at(int there);
    Sight look_for_loop(int there, Loop *loop) const;
    std::vector<Loop> partners_of(const Loop &loop) const;
    size_t partners_wanted(const Loop &loop) const;
    bool close(const Loop &loop, const std::vector<Loop> &partners);
    bool straighten();
    bool lay_on_known();
    bool optimise();
    bool is_tied(const Loop &loop) const;

    size_t capacity_;
    std::vector<Node> nodes_; // in the order of the way
    PoseGraph graph_;
    std::optional<KnownMap> known_;
    std::deque<Loop> pending_;
    std::vector<Neighbours> neighbours_; // along the way
    size_t added_ = 0;                   // nodes, ever
    size_t straightened_at_ = 0;         // how many had been added then
    int iterations_left_ = 0;            // of those that may follow from the present node
    std::optional<LoopSearch> search_;
    std::optional<Refinement> refinement_;
    bool refined_ = false; // nothing was added since
    LoopStatistics statistics_{};
};

} // namespace ale

#endif
