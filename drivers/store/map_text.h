/* A map as checked text: what map files hold, and each tile of a file of tiles.
 *
 *   ALE-SLAM map 1
 *   # wall: id start_x start_y end_x end_y var_alpha_nrad2 cov_um_nrad var_rho_um2 seen
 *   wall 17 -1200345 800000 3400000 801200 1200 -35 410 96
 *   # corner: x y var_xx var_xy var_yy angle_bam bisector_bam seen kind
 *   corner 3400000 801200 8100 -20 7700 1073741824 2684354560 51 1
 *   # pose: x y theta_bam
 *   pose 1200345 800000 4294000000
 *   end 2 9f3c01aa
 *
 * Lengths in um, variances in um^2, angles of corners in BAM; integers, so that a map comes back as it was.
 * The last line counts walls and corners and holds the CRC-32 (zlib's) of all lines before it. The pose,
 * where the robot was, may be missing. Lines with # are for people. */
#ifndef ALE_STORE_MAP_TEXT_H
#define ALE_STORE_MAP_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/pose.h"
#include "map/line_map.h"

/* No wall, corner or pose is farther from the origin along either axis: 1073 m. */
enum { ALE_MAP_FARTHEST_UM = 1 << 30 };

/* Walls and corners that fit a map have no longer text: none of its lines is longer than 256. */
enum { ALE_MAP_TEXT_MOST = 256 * (ALE_MAP_MAX_LINES + ALE_MAP_MAX_CORNERS + 100) };

/* What a text holds. */
typedef struct {
    ale_map_t map;
    ale_pose_t pose;
    bool pose_known;
} ale_map_text_t;

/* The whole text, the caller's to free; pose NULL: not known. NULL: no memory. */
char *ale_map_text_print(const ale_map_t *map, const ale_pose_t *pose, size_t *count);

/* Fills *content, zeroed by the caller, up to the text's last line. NULL, or what is wrong: not a map of
 * version 1, damaged or too large, cut short; *line_number is then the line, from 1. */
const char *ale_map_text_parse(const uint8_t *at, size_t count, ale_map_text_t *content,
                               uint64_t *line_number);

#endif
