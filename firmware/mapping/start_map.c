#include "mapping/start_map.h"

#include <stdlib.h>
#include <unistd.h>

#include "store/map_file.h"
#include "system/log_line.h"

/* True when there is something kept that can be read. */
static bool read_kept(const char *path, ale_map_t *map, ale_pose_t *pose, bool *known)
{
    char error[ALE_MAP_FILE_ERROR];
    if (path[0] == '\0' || access(path, F_OK) < 0) {
        return false;
    }
    if (ale_map_file_load_with_pose(path, map, pose, known, error) < 0) {
        ale_log_line("starting without what was kept: %s", error);
        return false;
    }
    return true;
}

/* True when map and pose of the last run are taken up. */
static bool load_kept(const char *path, ale_map_t *map, ale_estimator_t *estimator)
{
    ale_pose_t pose;
    bool known = false;
    if (!read_kept(path, map, &pose, &known)) {
        return false;
    }
    ale_estimator_load_map(estimator, map, known ? &pose : NULL);
    ale_log_line("going on from %s: %u walls, %u corners%s", path, map->line_count, map->corner_count,
                 known ? " and the last pose" : "");
    return true;
}

static int load_tiles(const ale_config_t *config, ale_map_t *map, ale_estimator_t *estimator,
                      ale_tile_loader_t **tiles, char error[ALE_MAP_FILE_ERROR])
{
    ale_pose_t pose;
    bool known = false;
    *tiles = ale_tile_loader_open(config->map, error);
    if (!*tiles) {
        return -1;
    }
    known = read_kept(config->keep, map, &pose, &known) && known;
    ale_estimator_load_tiles(estimator, known ? &pose : NULL);
    const ale_tile_file_t *file = ale_tile_loader_file(*tiles);
    ale_log_line("map of tiles %s: %u walls in %u tiles; %s", config->map, file->walls, file->count,
                 known ? "going on from the last pose"
                       : "where the robot is must be said (relocate), unless all of it is around the origin");
    return 0;
}

static int load_configured(const ale_config_t *config, ale_map_t *map, ale_estimator_t *estimator,
                           char error[ALE_MAP_FILE_ERROR])
{
    if (load_kept(config->keep, map, estimator) || config->map[0] == '\0') {
        return 0;
    }
    if (ale_map_file_load(config->map, map, error) < 0) {
        return -1;
    }
    ale_estimator_load_map(estimator, map, NULL);
    return 0;
}

int ale_start_map_load(const ale_config_t *config, ale_estimator_t *estimator, ale_tile_loader_t **tiles)
{
    char error[ALE_MAP_FILE_ERROR] = "out of memory";
    ale_map_t *map = malloc(sizeof *map);
    int status = -1;
    *tiles = NULL;
    if (map && ale_tile_file_is(config->map)) {
        status = load_tiles(config, map, estimator, tiles, error);
    } else if (map) {
        status = load_configured(config, map, estimator, error);
    }
    free(map);
    if (status < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error);
    }
    return status;
}
