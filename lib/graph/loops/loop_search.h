// Looks for all loops of a graph once more when the drive is over, and judges them together.
//
//   LoopSearch search(&nodes, graph);
//   while (search.step()) {
//   }
//   graph = search.graph();
//
// While driving a loop is believed or not at the moment it is found, and what is believed first decides what
// follows. Here every place is compared with every other visit, each with what was seen before it and after,
// in a window as wide as the graph's own covariance. Loops stand that others agree with and that do not put
// walls where was seen to be nothing. The graph is then solved by graduated non-convexity (Yang et al. 2020):
// at first all of them pull, then the robust kernel narrows and those that contradict the rest let go.
// The second round finds what the first has brought within reach.
//
// One step looks from one node or is one iteration of the solver: bounded, so that it can be spread.
#ifndef ALE_GRAPH_LOOPS_LOOP_SEARCH_H
#define ALE_GRAPH_LOOPS_LOOP_SEARCH_H

#include <optional>
#include <vector>

#include "graph/loops/free_space.h"
#include "graph/loops/loop.h"
#include "graph/optimise/node.h"
#include "graph/optimise/path_spread.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

class LoopSearch
{
  public:
    // The nodes stay the caller's, and as they are. Of the graph its poses, motions and loops are taken.
    LoopSearch(const std::vector<Node> *nodes, PoseGraph graph);

    // False: nothing is left to do.
    bool step();

    const PoseGraph &graph() const
    {
        return graph_;
    }

  private:
    struct Place {
        int k;
        SearchWindow window;
    };
    struct Found {
        Loop loop;
        bool displaced; // from where the graph has it, farther than a match next to it would be
    };

    std::vector<Place> places_near(int k) const;
    void look_from(int k);
    std::optional<Found> look_at(const Place &place, int k, const std::vector<SurfacePoint> &seen) const;
    double share_in_view(const std::vector<SurfacePoint> &seen, int from, const Pose &pose) const;
    bool is_contradicted(const Loop &loop) const;
    bool is_believed(const Found &found) const;
    std::vector<GraphEdge> edges() const;
    void keep_displaced();
    void solve();

    const std::vector<Node> *nodes_;
    PoseGraph graph_;
    std::vector<GraphEdge> given_; // motions, and loops believed while driving
    std::vector<FreeSpace> free_;  // by node
    std::optional<PathSpread> spread_;
    std::vector<Found> found_; // in this round
    int round_ = 0;
    int next_ = 0;   // node to look from
    int solved_ = 0; // iterations of this round
};

} // namespace ale

#endif
