// What a map knows around a node, whichever visit saw it, and how well that explains a view of another map.
// Every function may throw std::bad_alloc. Nodes stay the caller's and must outlive these.
#ifndef ALE_GRAPH_LOOPS_PLACE_H
#define ALE_GRAPH_LOOPS_PLACE_H

#include <cstdint>
#include <vector>

#include "graph/fields/free_space.h"
#include "graph/fields/likelihood_field.h"
#include "graph/loops/prior_views.h"
#include "graph/optimise/constraints.h"
#include "graph/optimise/node.h"

namespace ale
{

// All that places are of: nodes, what ties them, and the views of a saved map that the drive began in, or
// null where nothing is to be looked for in that. A number below 0 is that of a view: -1 the first. They stay
// the caller's.
struct SearchedMaps {
    const std::vector<Node> &nodes;
    const std::vector<Pose> &poses;
    const std::vector<GraphEdge> &edges;
    const PriorViews *prior;

    int first() const
    {
        return prior ? -static_cast<int>(prior->poses().size()) : 0;
    }
    int end() const
    {
        return static_cast<int>(nodes.size());
    }
    uint32_t map_of(int k) const;
    const Pose &pose_of(int k) const;
};

// A node, as seen from another.
struct SeenNode {
    const Node *node;
    Pose pose;
    FreeSpace space;
};

// What a node and those beside it along the path saw, in the node's frame. O(points).
struct View {
    View(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int of);

    int node;
    std::vector<SurfacePoint> points; // 600 at most
    std::vector<SeenNode> seen;
};

// How a view at some pose agrees with a place.
struct Explanation {
    double in_view; // part of the points that the place could show: no surface is before them, 0..1
    double agreed;  // part of what one could show of the other that does not lie in free space, 0..1. A saved
                    // map does not hold everything: things may stand in its free space,
    double told;    // and yet count here: what tells two places apart
};

class Place
{
  public:
    static constexpr double reach_m = 4.0;
    static constexpr size_t most_nodes = 16; // the nearest,
    static constexpr size_t most_views = 48; // or with views so many of both

    // The place around a node or view: those of its map within reach. O(nodes log nodes + points).
    Place(const SearchedMaps &maps, int anchor);
    Place(const Place &) = delete; // its nodes are pointed to
    Place &operator=(const Place &) = delete;

    int anchor() const
    {
        return anchor_;
    }
    // What its nodes saw, in the frame of the anchor, and the field of that.
    const std::vector<SurfacePoint> &points() const
    {
        return points_;
    }
    const LikelihoodField &field() const
    {
        return field_;
    }
    // The view at this pose in the frame of the anchor. O(points of view and place).
    Explanation explain(const View &view, const Pose &pose) const;

  private:
    double part_in_view(const View &view, const Pose &pose) const;
    void compare_free_space(const View &view, const Pose &pose, Explanation *out) const;

    int anchor_;
    std::vector<int> near_;   // all that it is of, the nearest first
    std::vector<Node> views_; // of these, the views
    std::vector<SeenNode> seen_;
    std::vector<SurfacePoint> points_;
    LikelihoodField field_;
};

} // namespace ale

#endif
