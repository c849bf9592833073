/* The map as it is handed out, stored and taken in: confirmed walls and corners, by value.
 *
 * Map frame throughout. The map in work is ale_local_map_t; map_exchange.h converts between them.
 */
#ifndef ALE_MAP_LINE_MAP_H
#define ALE_MAP_LINE_MAP_H

#include <stdint.h>

#include "base/pose.h"

#define ALE_MAP_MAX_LINES 2048
#define ALE_MAP_MAX_CORNERS 1024

/* One wall, seen from the side that its normal points to. */
typedef struct {
    uint32_t id;       /* stays with the wall while it lives */
    ale_point_t start; /* counter-clockwise as seen from the room: start is to the right */
    ale_point_t end;
    int64_t var_alpha_nrad2;
    int64_t cov_alpha_rho;
    int64_t var_rho_um2;
    uint32_t seen;   /* scans that support it */
    uint32_t map_id; /* of the map that it is in, as in ale_estimate_t; not kept in files */
} ale_map_line_t;

typedef struct {
    ale_point_t p;
    int64_t cov_um2[3];
    uint32_t angle_bam;
    uint32_t bisector_bam;
    uint32_t seen;
    uint8_t kind; /* ale_corner_kind_t */
} ale_map_corner_t;

typedef struct {
    uint32_t version; /* grows with every change */
    uint16_t line_count;
    uint16_t corner_count;
    uint32_t refused; /* features that found no room */
    ale_map_line_t line[ALE_MAP_MAX_LINES];
    ale_map_corner_t corner[ALE_MAP_MAX_CORNERS];
} ale_map_t;

#endif
