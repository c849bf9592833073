/* Export and import of the map as an ale_map_t (line_map.h). */
#ifndef ALE_MAP_MAP_EXCHANGE_H
#define ALE_MAP_MAP_EXCHANGE_H

#include "map/atlas.h"
#include "map/line_map.h"
#include "map/local_map.h"

/* Copies confirmed walls and corners, in their order in the map; walls are told to be in the maps of this
 * atlas. O(map). */
void ale_map_export(const ale_local_map_t *map, const ale_atlas_t *atlas, ale_map_t *out);

/* The wall of a map line, its anchor in the middle. False: it is shorter than 1 mm, *out is then not a wall.
 */
bool ale_map_line_wall(const ale_map_line_t *line, ale_wall_t *out);

/* Replaces the map; its version is that of `from` plus one. Walls shorter than 1 mm are left out. O(map). */
void ale_map_import(ale_local_map_t *map, const ale_map_t *from);

#endif
