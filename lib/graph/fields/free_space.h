// Free space that a node saw around it. Points of another node that lie in it are a free-space violation: one
// of the two is not where it is assumed to be. Metres, the node's frame.
#ifndef ALE_GRAPH_FIELDS_FREE_SPACE_H
#define ALE_GRAPH_FIELDS_FREE_SPACE_H

#include <array>

#include "graph/optimise/node.h"

namespace ale
{

struct FreeSpaceCheck {
    int points = 0;     // within the view
    int violations = 0; // of these, clearly nearer than the surface seen there
};

class FreeSpace
{
  public:
    // The nearest range in each of 360 sectors. O(points); nothing here throws.
    explicit FreeSpace(const Node &node);

    // Whether the node had this point in view: no surface nearer hides it. O(1).
    bool has_in_view(const Eigen::Vector2d &p) const;

    // Adds the counts for the points of another node, which lies at `pose`. O(points).
    void check(const Node &other, const Pose &pose, FreeSpaceCheck *sum) const;

  private:
    static constexpr int sectors = 360;
    static int sector_of(const Eigen::Vector2d &from_sensor);
    double range_towards(const Eigen::Vector2d &from_sensor) const;

    Eigen::Vector2d sensor_;
    std::array<float, sectors> range_m_; // by bearing in the node's frame; 0: nothing was seen
};

} // namespace ale

#endif
