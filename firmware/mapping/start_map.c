#include "mapping/start_map.h"

#include <stdlib.h>
#include <unistd.h>

#include "store/map_file.h"
#include "system/log_line.h"

/* True when map and pose of the last run are taken up. */
static bool load_kept(const char *path, ale_map_t *map, ale_estimator_t *estimator)
{
    char error[ALE_MAP_FILE_ERROR];
    ale_pose_t pose;
    bool known = false;
    if (path[0] == '\0' || access(path, F_OK) < 0) {
        return false;
    }
    if (ale_map_file_load_with_pose(path, map, &pose, &known, error) < 0) {
        ale_log_line("starting without what was kept: %s", error);
        return false;
    }
    ale_estimator_load_map(estimator, map, known ? &pose : NULL);
    ale_log_line("going on from %s: %u walls, %u corners%s", path, map->line_count, map->corner_count,
                 known ? " and the last pose" : "");
    return true;
}

int ale_start_map_load(const ale_config_t *config, ale_estimator_t *estimator)
{
    char error[ALE_MAP_FILE_ERROR] = "out of memory";
    ale_map_t *map = malloc(sizeof *map);
    int status = map ? 0 : -1;
    if (map && !load_kept(config->keep, map, estimator) && config->map[0] != '\0') {
        status = ale_map_file_load(config->map, map, error);
        if (status == 0) {
            ale_estimator_load_map(estimator, map, NULL);
        }
    }
    free(map);
    if (status < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error);
    }
    return status;
}
