// Which maps there are, and which have become part of another. Ids are the tracker's (map/atlas.h); a node
// carries the id of the map that it is part of now. Nothing here throws but largest_map.
#ifndef ALE_GRAPH_LOOPS_MAP_TABLE_H
#define ALE_GRAPH_LOOPS_MAP_TABLE_H

#include <array>
#include <cstdint>
#include <vector>

#include "graph/optimise/node.h"

extern "C" {
#include "map/atlas.h"
}

namespace ale
{

// One map becomes part of another; all of it moves by `shift`.
struct MapJoin {
    uint32_t map_id;
    uint32_t into_map_id;
    Pose shift;
};

// The id of a map as the tracker names it -> the map that it is part of.
class MapTable
{
  public:
    // The latest joins. The tracker knows ALE_ATLAS_MAPS maps at most, and names none that joined long ago.
    static constexpr size_t most_joins = 64;

    // The map itself if it has not joined another. O(1).
    uint32_t now(uint32_t map_id) const;
    // Both are maps that have not joined another. O(1).
    void join(uint32_t map_id, uint32_t into_map_id);
    // O(1).
    void clear()
    {
        count_ = 0;
    }

  private:
    struct Joined {
        uint32_t map_id;
        uint32_t part_of;
    };
    std::array<Joined, most_joins> joined_{};
    size_t count_ = 0; // ever
};

// How many maps these nodes are of. O(nodes * how often the map changes along the path).
size_t count_maps(const std::vector<Node> &nodes);

// The map of most nodes; of equals the oldest. There is a node. O(nodes log maps).
uint32_t largest_map(const std::vector<Node> &nodes);

} // namespace ale

#endif
