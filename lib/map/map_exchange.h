/* The map as it is handed out and taken in: see ale_map_t. */
#ifndef ALE_MAP_MAP_EXCHANGE_H
#define ALE_MAP_MAP_EXCHANGE_H

#include "map/line_map.h"
#include "map/local_map.h"

/* Confirmed walls and corners, in the order they lie in the map. O(map). */
void ale_map_export(const ale_local_map_t *map, ale_map_t *out);

/* The wall that a line of a map is. False: it is shorter than 1 mm. */
bool ale_map_line_wall(const ale_map_line_t *line, ale_wall_t *out);

/* Replaces the map. Walls shorter than 1 mm are left out. O(map). */
void ale_map_import(ale_local_map_t *map, const ale_map_t *from);

#endif
