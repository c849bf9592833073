/* Map files: walls and corners as text (map_text.h). A file that was cut or damaged is refused whole. */
#ifndef ALE_STORE_MAP_FILE_H
#define ALE_STORE_MAP_FILE_H

#include "track/pipeline.h"

enum { ALE_MAP_FILE_ERROR = 320 };

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
