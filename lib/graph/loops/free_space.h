// What a node saw to be free: where another node's points lie in it, one of the two is not where it is said
// to be.
#ifndef ALE_GRAPH_LOOPS_FREE_SPACE_H
#define ALE_GRAPH_LOOPS_FREE_SPACE_H

#include <array>

#include "graph/optimise/node.h"

namespace ale
{

struct Contradiction {
    int points = 0;  // that lie where the view reaches
    int in_free = 0; // of these, clearly before what was seen there
};

class FreeSpace
{
  public:
    explicit FreeSpace(const Node &node);

    // Whether the node would have seen a surface at this point, given in its frame: nothing nearer hides it.
    bool reaches(const Eigen::Vector2d &p) const;

    // Adds what the points of another node say, which lies at `pose` as seen from this one.
    void confront(const Node &other, const Pose &pose, Contradiction *sum) const;

  private:
    static constexpr int sectors = 360;
    static int sector_of(const Eigen::Vector2d &from_eye);
    double range_towards(const Eigen::Vector2d &from_eye) const;

    Eigen::Vector2d eye_;
    std::array<float, sectors> range_m_; // by bearing in the node's frame; 0: nothing was seen
};

} // namespace ale

#endif
