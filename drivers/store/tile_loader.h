/* Reads the tiles around the robot as it goes on, and says what comes and goes.
 *
 *   ale_tile_loader_t *loader = ale_tile_loader_open(path, error);
 *   ale_tile_loader_follow(loader, &whereabouts);            (what ale_pipeline_whereabouts says, in order)
 *   while (ale_tile_loader_next(loader, &piece)) ...         (to ale_pipeline_change_tiles, in order)
 *
 * Memory is that of the tiles around the robot and 24 bytes for every tile of the file. The same whereabouts
 * give the same pieces: no clock. For an ordinary thread: it blocks as disks do. */
#ifndef ALE_STORE_TILE_LOADER_H
#define ALE_STORE_TILE_LOADER_H

#include "map/tile_change.h"
#include "store/tile_file.h"

typedef struct ale_tile_loader ale_tile_loader_t;

/* NULL with one line in *error: see ale_tile_file_open. */
ale_tile_loader_t *ale_tile_loader_open(const char *path, char error[ALE_MAP_FILE_ERROR]);
void ale_tile_loader_close(ale_tile_loader_t *loader); /* NULL: nothing */

const ale_tile_file_t *ale_tile_loader_file(const ale_tile_loader_t *loader);

/* Works out which tiles are wanted now and reads those that are not loaded. Around a robot that goes on, a
 * tile stays half a side longer than it would be fetched. Where walls are so many that the tiles within reach
 * hold more than ALE_TILE_WALLS, as many as do are loaded, the nearest. What was found before and has not
 * been asked for is void: ask for all first. */
void ale_tile_loader_follow(ale_tile_loader_t *loader, const ale_whereabouts_t *whereabouts);

/* The next piece of what the last call of follow has found; false: no more. */
bool ale_tile_loader_next(ale_tile_loader_t *loader, ale_tile_change_t *out);

/* What did not go as it should, since the file was opened. */
typedef struct {
    uint32_t unread;                /* tiles, so often; they count as empty */
    char error[ALE_MAP_FILE_ERROR]; /* of the last one */
    uint32_t refused;               /* walls and corners for which there was no room */
    int64_t reach_um;               /* within which all is loaded now, */
    int64_t wanted_um;              /* and should be */
} ale_tile_trouble_t;

const ale_tile_trouble_t *ale_tile_loader_trouble(const ale_tile_loader_t *loader);

#endif
