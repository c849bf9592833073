// Searches for all loops of a graph again after the drive, and decides about them together.
//
//   LoopSearch search(&nodes, graph);
//   while (search.step()) {
//   }
//   graph = search.graph();
//
// While driving a loop is accepted or not when it is found, and the first ones decide what follows. Here
// every place is matched with every other visit, with the nodes before and after both, in a window as wide as
// the covariance of the graph. Loops remain that others confirm and that violate no free space. The graph is
// then solved by graduated non-convexity (Yang et al., RA-L 2020): at first all loops count, then the robust
// kernel narrows and those that contradict the rest lose their weight. Where many loops agree on a falsehood,
// such as walls of two rooms that stand nearly alike, that can end on their side against all else: the graph
// is also solved from where it was, and the solution that costs less is kept. Each round finds what the one
// before has brought within reach, two at least, until none displaces anything, four at most.
#ifndef ALE_GRAPH_LOOPS_LOOP_SEARCH_H
#define ALE_GRAPH_LOOPS_LOOP_SEARCH_H

#include <optional>
#include <vector>

#include "graph/fields/free_space.h"
#include "graph/loops/loop.h"
#include "graph/optimise/node.h"
#include "graph/optimise/path_covariance.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

class LoopSearch
{
  public:
    // The nodes stay the caller's and must outlive this, unchanged. May throw std::bad_alloc, as step() may.
    LoopSearch(const std::vector<Node> *nodes, PoseGraph graph);

    // Matches one node with three places at most, in windows of 10 m and 0.5 rad at most (loop_match.h), or
    // solves one iteration. False: done.
    bool step();

    // The result once step() has returned false.
    const PoseGraph &graph() const
    {
        return graph_;
    }

  private:
    struct Place {
        int node;
        SearchWindow window;
    };
    struct FoundLoop {
        Loop loop;
        bool displaced; // farther from its pose in the graph than a match of neighbours would be
    };

    std::vector<Place> places_near(int k) const;
    void search_from(int k);
    std::optional<FoundLoop> match_place(const Place &place, int k,
                                         const std::vector<SurfacePoint> &seen) const;
    double part_in_view(const std::vector<SurfacePoint> &seen, int from, const Pose &pose) const;
    bool violates_free_space(const Loop &loop) const;
    bool is_confirmed(const FoundLoop &found) const;
    std::vector<GraphEdge> edges() const;
    bool keep_displaced();
    void solve();
    bool is_solved() const;
    void select_solution();

    const std::vector<Node> *nodes_;
    PoseGraph graph_;
    std::vector<GraphEdge> given_;      // odometry, and loops accepted while driving
    std::vector<FreeSpace> free_space_; // by node
    std::optional<PathCovariance> covariance_;
    std::optional<PoseGraph> as_begun_; // solved from where it was, beside graph_ from all loops
    std::vector<FoundLoop> found_;      // in this round
    int round_ = 0;
    int next_ = 0;   // node to search from
    int solved_ = 0; // iterations of this round
};

} // namespace ale

#endif
