// Where a view lies in a place, with nothing known of it: any heading, any position near the anchor. Headings
// are those that bring the normals of the one onto those of the other.
//
//   PlaceSearch search(place);
//   for (const LoopMatch &match : search.find(view.points)) ...
//
// Two steps of branch and bound (Olson, "M3RSM", ICRA 2015): blocks of positions are bounded on a pooled
// field, the best are searched in full, and the best of these refined point to line.
#ifndef ALE_GRAPH_LOOPS_PLACE_SEARCH_H
#define ALE_GRAPH_LOOPS_PLACE_SEARCH_H

#include <vector>

#include "graph/fields/position_grid.h"
#include "graph/loops/loop_match.h"
#include "graph/loops/place.h"

namespace ale
{

class PlaceSearch
{
  public:
    static constexpr double half_m = 3.2; // of positions, about the anchor
    static constexpr size_t most_found = 6;

    // The place must outlive this. O(cells); may throw std::bad_alloc.
    explicit PlaceSearch(const Place &place);

    // The best poses of these points that are different places; ambiguity is 0 in each. Work: 44,000 blocks
    // with 63 points at most, 8,000 positions, 400 of them with some 240, 72 least-squares passes. May throw
    // std::bad_alloc.
    std::vector<LoopMatch> find(const std::vector<SurfacePoint> &points) const;

  private:
    // Some of the points, turned each way that is searched, as cells of the field.
    using Turned = std::vector<std::vector<LikelihoodField::Cell>>;
    // A turn of those, and how many cells from the anchor.
    struct Position {
        size_t turn;
        int x;
        int y;
    };

    std::vector<size_t> best_turns(const std::vector<SurfacePoint> &points) const;
    Turned turned(const std::vector<SurfacePoint> &few, const std::vector<size_t> &turns) const;
    std::vector<Position> best_blocks(const Turned &points) const;
    std::vector<Position> best_positions(const Turned &points, const std::vector<Position> &blocks) const;

    const LikelihoodField &field_;
    PositionGrid blocks_;
    PositionGrid positions_;
    std::vector<double> normals_; // how many point which way
};

} // namespace ale

#endif
