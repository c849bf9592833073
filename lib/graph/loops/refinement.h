// Draws a graph tight after the drive: every node is matched anew with its neighbours of all visits, and the
// poses follow.
//
//   Refinement refinement(&nodes, graph);
//   while (refinement.step()) {
//   }
//   graph = refinement.graph();
//
// Loops say where a place lies when drift has displaced it; this says how places that overlap lie to each
// other, to what scans allow. One step matches nodes_per_step nodes or solves the graph once: bounded, so
// that it can be spread.
#ifndef ALE_GRAPH_LOOPS_REFINEMENT_H
#define ALE_GRAPH_LOOPS_REFINEMENT_H

#include <optional>
#include <vector>

#include "graph/loops/known_map.h"
#include "graph/optimise/node.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

class Refinement
{
  public:
    // The nodes stay the caller's, and as they are. Of the graph its poses, motions and loops are taken.
    // known: the map that the drive began in, or nullptr; every node is matched with it, too.
    Refinement(const std::vector<Node> *nodes, PoseGraph graph, const KnownMap *known = nullptr);

    // False: nothing is left to do.
    bool step();

    const PoseGraph &graph() const
    {
        return graph_;
    }

  private:
    std::vector<int> neighbours_of(int k) const;
    void match_around(int k);
    void match_known(int k);
    std::vector<GraphEdge> still_needed() const;
    void follow_walls();
    void solve();
    bool is_solved() const;
    void choose();

    const std::vector<Node> *nodes_;
    const KnownMap *known_;
    PoseGraph graph_;
    std::optional<PoseGraph> turned_; // to the walls' headings, while it is solved without them
    std::vector<GraphEdge> given_;    // motions and loops
    std::vector<GraphEdge> matched_;  // of this round
    std::vector<PoseAnchor> anchors_;
    int round_ = 0;
    int next_ = 0; // node to match
    int solved_ = 0;
    bool drifted_; // headings, while driving or since
};

} // namespace ale

#endif
