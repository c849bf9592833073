// What a robot would see of a saved map from places all over it: as nodes are for maps of the drive, these
// are for that map. Metres, radians, map frame.
#ifndef ALE_GRAPH_LOOPS_PRIOR_VIEWS_H
#define ALE_GRAPH_LOOPS_PRIOR_VIEWS_H

#include <vector>

#include "graph/optimise/node.h"

extern "C" {
#include "map/wall.h"
}

namespace ale
{

class PriorViews
{
  public:
    static constexpr double apart_m = 1.0; // of the places, along both axes

    // Finds the places of a grid from which walls within 12 m are seen, mostly from the side that they were
    // seen from; of 16,384 places near walls at most. Work: a view for each of these. May throw
    // std::bad_alloc, as at().
    explicit PriorViews(const std::vector<ale_wall_t> &walls);

    // Of the places; heading 0.
    const std::vector<Pose> &poses() const
    {
        return poses_;
    }
    // What is seen from that place, in all directions: points and normals, no corners. O(walls).
    Node at(size_t k) const;

  private:
    struct Segment {
        Eigen::Vector2d start;
        Eigen::Vector2d along; // to the end
        Eigen::Vector2d normal;
    };
    // What a beam meets.
    struct Hit {
        double range_m;
        const Segment *segment; // nullptr: nothing
    };

    static std::vector<Segment> segments_of(const std::vector<ale_wall_t> &walls);
    std::vector<Pose> grid_near_walls() const;
    std::vector<Hit> hits_from(const Eigen::Vector2d &place) const;
    bool is_inside(const Eigen::Vector2d &place) const;

    std::vector<Segment> segments_;
    std::vector<Pose> poses_;
};

} // namespace ale

#endif
