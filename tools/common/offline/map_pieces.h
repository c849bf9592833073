/* The map at the end, each of the maps that are not joined drawn for itself: walls of two frames are never
 * taken for one. */
#ifndef ALE_COMMON_OFFLINE_MAP_PIECES_H
#define ALE_COMMON_OFFLINE_MAP_PIECES_H

#include <cstdint>
#include <functional>

#include "graph/walls/map_rebuild.h"

namespace ale
{

/* Number of the map that a scan is in. */
using MapOfScan = std::function<uint32_t(uint32_t scan)>;

/* Rebuilds the maps (map_rebuild.h), the first one first; lines name theirs, ids are from 0. What does not
 * fit is counted in out->refused. */
void rebuild_pieces(const ObservationRecord &record, const PoseOfScan &pose_of, const MapOfScan &map_of,
                    ale_map_t *out);

} // namespace ale

#endif
