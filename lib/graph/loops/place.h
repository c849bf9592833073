// What a map knows around a node, whichever visit saw it, and how well that explains a view of another map.
// Every function may throw std::bad_alloc. Nodes stay the caller's and must outlive these.
#ifndef ALE_GRAPH_LOOPS_PLACE_H
#define ALE_GRAPH_LOOPS_PLACE_H

#include <vector>

#include "graph/fields/free_space.h"
#include "graph/fields/likelihood_field.h"
#include "graph/optimise/node.h"

namespace ale
{

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
    double agreed;  // part of what one could show of the other that does not lie in free space, 0..1
};

class Place
{
  public:
    static constexpr double reach_m = 4.0;
    static constexpr size_t most_nodes = 16; // the nearest

    // The place around a node: the nodes of its map within reach. O(nodes log nodes + points).
    Place(const std::vector<Node> &nodes, const std::vector<Pose> &poses, int anchor);

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
    double part_agreed(const View &view, const Pose &pose) const;

    int anchor_;
    std::vector<SeenNode> seen_;
    std::vector<SurfacePoint> points_;
    LikelihoodField field_;
};

// Nodes of a map, such that each other of it is within `apart_m` of one. O(n^2).
std::vector<int> spread_nodes(const std::vector<Node> &nodes, const std::vector<Pose> &poses, uint32_t map_id,
                              double apart_m);

} // namespace ale

#endif
