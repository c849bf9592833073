/* Map files: walls and corners as text, versioned and checksummed.
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
 * The last line counts walls and corners and holds the CRC-32 (zlib's) of all lines before it: a file that
 * was cut or damaged is refused whole. The pose, where the robot was, may be missing. Lines with # are for
 * people. */
#ifndef ALE_STORE_MAP_FILE_H
#define ALE_STORE_MAP_FILE_H

#include "track/pipeline.h"

/* No wall, corner or pose of a file is farther from the origin along either axis: 1073 m. */
enum { ALE_MAP_FILE_FARTHEST_UM = 1 << 30 };

/* No map is larger: its lines are at most so many, and none is longer than this. */
enum { ALE_MAP_FILE_ERROR = 320, ALE_MAP_FILE_MOST = 256 * (ALE_MAP_MAX_LINES + ALE_MAP_MAX_CORNERS + 100) };

/* Writes beside the file, flushes to the disk and renames: whatever happens, the file is the old or the new
 * map, with rights 0640. pose NULL: not known. 0, or -1 with one line in *error: no memory, a link or no
 * regular file where the map is to be, or the system's words. May block for as long as the disk takes;
 * allocates. */
int ale_map_file_save_with_pose(const char *path, const ale_map_t *map, const ale_pose_t *pose,
                                char error[ALE_MAP_FILE_ERROR]);
int ale_map_file_save(const char *path, const ale_map_t *map, char error[ALE_MAP_FILE_ERROR]);

/* Loads a map, version 1. 0, or -1 with one line in *error and nothing set: not readable (the system's
 * words), a symbolic link, no regular file, too large, no memory, or with the number of the line not a map of
 * version 1, damaged or too large, cut short. *known: the file says where the robot was; only then *pose is
 * set. */
int ale_map_file_load_with_pose(const char *path, ale_map_t *map, ale_pose_t *pose, bool *known,
                                char error[ALE_MAP_FILE_ERROR]);

/* The same for those who do not ask for the pose. */
int ale_map_file_load(const char *path, ale_map_t *map, char error[ALE_MAP_FILE_ERROR]);

#endif
