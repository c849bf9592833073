/* The map as an occupancy grid: walls of the robot's map, and what the scans saw on the way.
 *
 *   occupancy.take(scan); occupancy.take(pose); occupancy.take(tracking); occupancy.take(graph);
 *                                                                             (as they come)
 *   occupancy.take(map, pieces);                                              (a whole map)
 *   if (occupancy.has_changed()) grid = occupancy.grid();
 *
 * Walls are always those of the newest map; what scans saw is begun anew with it (common/feed/seen_space.h).
 */
#ifndef ALE_COMMON_FEED_OCCUPANCY_H
#define ALE_COMMON_FEED_OCCUPANCY_H

#include <memory>

#include "common/export/occupancy_grid.h"
#include "common/feed/core_types.h"
#include "common/feed/seen_space.h"

namespace feed
{

class Occupancy
{
  public:
    template <class Message> void take(const Message &message)
    {
        changed_ = seen_.take(message) || changed_;
    }
    /* Only walls of the first map are drawn. */
    void take(const ale::map_t &map, const MapPieces &pieces);

    /* There is something to show that the last grid() has not. */
    bool has_changed() const
    {
        return changed_;
    }
    /* Throws std::runtime_error when the map is too large; what was seen is forgotten then. */
    ale::OccupancyGrid grid();

  private:
    std::unique_ptr<ale_map_t> map_ = std::make_unique<ale_map_t>();
    SeenSpace seen_;
    bool changed_ = false;
};

} // namespace feed

#endif
