#include "common/feed/occupancy.h"

#include <algorithm>
#include <stdexcept>

namespace feed
{

namespace
{

/* A grid of 200 m by 200 m goes out. */
constexpr int64_t most_cells = 16000000;

} // namespace

void Occupancy::take(const ale::map_t &map, const MapPieces &pieces)
{
    map_ = core_map(map, pieces);
    const auto end = std::remove_if(map_->line, map_->line + map_->line_count, ale::is_apart);
    map_->line_count = static_cast<uint16_t>(end - map_->line);
    changed_ = true;
}

ale::OccupancyGrid Occupancy::grid()
{
    changed_ = false;
    ale::MapScene scene;
    scene.map = map_.get();
    scene.cloud = &seen_.cloud();
    try {
        return ale::occupancy_of(scene, most_cells);
    } catch (const std::runtime_error &) {
        seen_.forget();
        throw;
    }
}

} // namespace feed
