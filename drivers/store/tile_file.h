/* A map of any size in one file, by tiles: squares that are read one by one as the robot goes on.
 *
 *   ALE-SLAM tiles 1
 *   # map: side_um walls corners
 *   map 10000000 251300 40100
 *   # tile: x y walls corners first_byte bytes
 *   tile -3 12 40 8 0 3310
 *   ...
 *   end 9800 9f3c01aa
 *   ALE-SLAM map 1
 *   ...
 *
 * The index ends with the number of tiles and the CRC-32 of all lines before. Behind it the tiles lie one
 * after another, each as the text of a map (map_text.h) with its own CRC; first_byte counts from the end of
 * the index. A wall is in every tile that it touches (map/tile_grid.h), whole and with the same number, which
 * is its own and not 0; a corner is in one. Tiles ascend by y, then x; one in which nothing is is left out.
 *
 * A damaged index is refused; a damaged tile costs itself and nothing else. */
#ifndef ALE_STORE_TILE_FILE_H
#define ALE_STORE_TILE_FILE_H

#include <stddef.h>
#include <stdio.h>

#include "map/line_map.h"
#include "map/tile_grid.h"
#include "store/map_file.h"
#include "store/map_text.h"

/* A tile holds no more than a map; of this side it does in any building. */
enum { ALE_TILE_SIDE_UM = 10000000 };

/* Largest index. */
enum { ALE_TILES_MOST = 1 << 20 };

/* A map of any size; borrowed. */
typedef struct {
    const ale_map_line_t *line;
    size_t line_count;
    const ale_map_corner_t *corner;
    size_t corner_count;
} ale_whole_map_t;

/* Writes walls and corners by tiles, numbering walls anew from 1: whole or not at all, as map files
 * (file/whole_file.h). side_um: whole millimetres within tile_grid.h. 0, or -1 with one line in *error: out
 * of memory, a wall or corner beyond ALE_MAP_FARTHEST_UM, a tile that holds more than a map, or the system's
 * words. Memory: some three times the file. */
int ale_tile_file_save(const char *path, const ale_whole_map_t *map, int32_t side_um,
                       char error[ALE_MAP_FILE_ERROR]);

typedef struct {
    int32_t x;
    int32_t y;
    uint64_t first_byte;
    uint32_t bytes;
    uint16_t walls;
    uint16_t corners;
} ale_tile_entry_t;

/* An open file: the index in memory, 24 bytes a tile. What is read is that file to the end, even if another
 * one takes its place meanwhile. */
typedef struct {
    FILE *in;
    uint64_t index_bytes;
    int32_t side_um;
    uint32_t walls;
    uint32_t corners;
    uint32_t count;
    ale_tile_entry_t *tile;
} ale_tile_file_t;

/* Whether the file begins as one of tiles does. */
bool ale_tile_file_is(const char *path);

/* 0, or -1 with one line in *error and nothing left open: not readable, a link, no regular file, no file of
 * tiles, or, with the number of the line, a damaged index. */
int ale_tile_file_open(ale_tile_file_t *file, const char *path, char error[ALE_MAP_FILE_ERROR]);
void ale_tile_file_close(ale_tile_file_t *file);

/* NULL: nothing is there. O(log tiles). */
const ale_tile_entry_t *ale_tile_file_find(const ale_tile_file_t *file, int32_t x, int32_t y);

/* Reads a tile. 0, or -1 with one line in *error and *out untouched: damaged, cut short, no memory, or the
 * system's words. */
int ale_tile_file_read(const ale_tile_file_t *file, const ale_tile_entry_t *tile, ale_map_t *out,
                       char error[ALE_MAP_FILE_ERROR]);

#endif
