// The present node, the last one, matched with a place that an earlier visit saw.
#ifndef ALE_GRAPH_LOOPS_VISIT_MATCH_H
#define ALE_GRAPH_LOOPS_VISIT_MATCH_H

#include <optional>
#include <vector>

#include "graph/loops/loop.h"
#include "graph/loops/submap.h"
#include "graph/optimise/node.h"

namespace ale
{

constexpr size_t most_visits = 3;
constexpr int visit_nodes = 6; // to each side of the place
constexpr SubmapExtent visit_here{2, 0};
constexpr double drift_per_metre = 0.008; // of the guess

struct VisitMatch {
    enum Outcome { unclear, recognised, displaced } outcome;
    Loop loop; // as matched where displaced, else as tracked
};

// Earlier nodes of the present map near the present pose, visited long ago: the nearest of each visit. O(n
// log n); may throw std::bad_alloc.
std::vector<int> earlier_visits(const std::vector<Node> &nodes, const std::vector<Pose> &poses);

// A place, and how far along the path it reaches.
struct Visit {
    int node;
    SubmapExtent extent;
};

// The node of a map nearest to a pose, and as far as its neighbours along the path are of that map. None: no
// node is. O(n).
std::optional<Visit> visit_near(const std::vector<Node> &nodes, const std::vector<Pose> &poses,
                                const Pose &here, uint32_t map_id);

// Matches the present node with the place of node `there`, which has this extent. One match_submap; may throw
// std::bad_alloc.
VisitMatch match_visit(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int there,
                       const SubmapExtent &extent = {visit_nodes, visit_nodes});

} // namespace ale

#endif
