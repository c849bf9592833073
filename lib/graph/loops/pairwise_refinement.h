// Refines a graph after the drive: every node is matched again with its neighbours of all visits, and the
// graph is solved with these matches.
//
//   PairwiseRefinement refinement(&nodes, graph);
//   while (refinement.step()) {
//   }
//   graph = refinement.graph();
//
// Loops correct drift; these matches give overlapping views their relative pose as accurately as scans allow.
#ifndef ALE_GRAPH_LOOPS_PAIRWISE_REFINEMENT_H
#define ALE_GRAPH_LOOPS_PAIRWISE_REFINEMENT_H

#include <optional>
#include <vector>

#include "graph/loops/prior_map.h"
#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

class PairwiseRefinement
{
  public:
    // Nodes and prior map stay the caller's and must outlive this, unchanged. prior: the map that the drive
    // began in, or nullptr; every node is matched with it, too. May throw std::bad_alloc, as step() may.
    PairwiseRefinement(const std::vector<Node> *nodes, PoseGraph graph, const PriorMap *prior = nullptr);

    // Matches eight nodes or solves one iteration. False: done.
    bool step();

    // The result once step() has returned false.
    const PoseGraph &graph() const
    {
        return graph_;
    }

  private:
    std::vector<int> neighbours_of(int k) const;
    void match_neighbours(int k);
    void match_prior_map(int k);
    std::vector<GraphEdge> edges_to_keep() const;
    void update_building_constraint();
    void solve();
    bool is_solved() const;
    void select_solution();

    const std::vector<Node> *nodes_;
    const PriorMap *prior_;
    PoseGraph graph_;
    std::optional<PoseGraph> constrained_; // by the building, while graph_ is solved without that
    std::vector<GraphEdge> given_;         // odometry and loops
    std::vector<GraphEdge> matched_;       // in this round
    std::vector<PosePrior> pose_priors_;
    int round_ = 0;
    int next_ = 0; // node to match
    int solved_ = 0;
    bool drifted_;          // headings, while driving or since
    uint32_t building_map_; // that the building constraint is of
};

} // namespace ale

#endif
