/* The map as an occupancy grid: walls of the robot's map, and what the scans saw on the way.
 *
 *   occupancy.take(scan); occupancy.take(pose); occupancy.take(tracking); occupancy.take(graph);
 *                                                                             (as they come)
 *   occupancy.take(map, pieces);                                              (a whole map)
 *   if (occupancy.has_changed()) grid = occupancy.grid();
 *
 * Walls are always those of the newest map. A scan is laid out at its own map pose; when the map pose takes a
 * step (a loop was closed, another map, one that was forgotten) what was seen before lies wrong, and is begun
 * anew. */
#ifndef ROS2_OCCUPANCY_H
#define ROS2_OCCUPANCY_H

#include <memory>
#include <optional>

#include "ale/graph_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/export/occupancy_grid.h"
#include "common/feed/core_types.h"
#include "operator/ros2/geometry.h"

namespace ros2
{

class Occupancy
{
  public:
    Occupancy()
    {
        forget();
    }

    void take(const ale::scan_t &scan);
    void take(const ale::pose_t &pose);
    void take(const ale::tracking_t &tracking);
    void take(const ale::graph_t &graph);
    /* Only walls of the first map are drawn. */
    void take(const ale::map_t &map, const feed::MapPieces &pieces);

    /* There is something to show that the last grid() has not. */
    bool has_changed() const
    {
        return changed_;
    }
    /* Throws std::runtime_error when the map is too large; what was seen is forgotten then. */
    ale::OccupancyGrid grid();

  private:
    void add_scan();
    void forget(); /* what the scans saw */
    bool steps(const ale::pose_t &pose) const;

    std::optional<ale::scan_t> scan_; /* waits for its pose and its map, or these for it */
    std::optional<ale::pose_t> pose_;
    std::optional<ale::tracking_t> tracking_;
    std::unique_ptr<ale_map_t> map_ = std::make_unique<ale_map_t>();
    std::unique_ptr<ale::ScanCloud> cloud_;
    std::optional<int32_t> first_scan_; /* that the map began with */
    bool changed_ = false;
};

} // namespace ros2

#endif
