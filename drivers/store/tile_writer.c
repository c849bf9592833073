/* ale_tile_file_save: sorts walls and corners into tiles, and writes index and tiles. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/fixed.h"
#include "file/whole_file.h"
#include "store/tile_file.h"

enum { RIGHTS = 0640 };

/* That a tile holds a wall or a corner. */
typedef struct {
    int32_t x;
    int32_t y;
    bool is_corner;
    uint32_t index;
} entry_t;

typedef struct {
    entry_t *at;
    size_t count;
    size_t room;
} entries_t;

static bool add_entry(entries_t *entries, entry_t entry)
{
    if (entries->count == entries->room) {
        const size_t room = entries->room == 0 ? 1024 : 2 * entries->room;
        entry_t *more = realloc(entries->at, room * sizeof *more);
        if (!more) {
            return false;
        }
        entries->at = more;
        entries->room = room;
    }
    entries->at[entries->count++] = entry;
    return true;
}

static ale_tile_range_t range_of(ale_point_t start, ale_point_t end, int32_t side_um)
{
    const ale_tile_range_t a = ale_tile_range_around(start, 0, side_um);
    const ale_tile_range_t b = ale_tile_range_around(end, 0, side_um);
    return (ale_tile_range_t){(int32_t)ale_min64(a.first_x, b.first_x),
                              (int32_t)ale_min64(a.first_y, b.first_y),
                              (int32_t)ale_max64(a.last_x, b.last_x), (int32_t)ale_max64(a.last_y, b.last_y)};
}

static bool sort_wall_in(entries_t *entries, const ale_map_line_t *wall, uint32_t index, int32_t side_um)
{
    const ale_tile_range_t range = range_of(wall->start, wall->end, side_um);
    bool fits = true;
    for (int32_t y = range.first_y; y <= range.last_y; y++) {
        for (int32_t x = range.first_x; x <= range.last_x; x++) {
            const ale_box_t box = ale_tile_range_box((ale_tile_range_t){x, y, x, y}, side_um);
            if (ale_box_touches(&box, wall->start, wall->end)) {
                fits = fits && add_entry(entries, (entry_t){x, y, false, index});
            }
        }
    }
    return fits;
}

static int compare(const void *left, const void *right)
{
    const entry_t *a = left;
    const entry_t *b = right;
    if (a->y != b->y) {
        return a->y < b->y ? -1 : 1;
    }
    if (a->x != b->x) {
        return a->x < b->x ? -1 : 1;
    }
    return a->is_corner != b->is_corner ? (int)a->is_corner - (int)b->is_corner
                                        : (a->index > b->index) - (a->index < b->index);
}

static bool is_far(ale_point_t p)
{
    return ale_max64(ale_abs64(p.x_um), ale_abs64(p.y_um)) > ALE_MAP_FARTHEST_UM;
}

/* NULL, or what is wrong. */
static const char *sort_in(entries_t *entries, const ale_whole_map_t *map, int32_t side_um)
{
    bool fits = true;
    if (map->line_count >= UINT32_MAX || map->corner_count >= UINT32_MAX) {
        return "too large";
    }
    for (uint32_t k = 0; k < map->line_count; k++) {
        if (is_far(map->line[k].start) || is_far(map->line[k].end)) {
            return "a wall is farther from the origin than 1073 m";
        }
        fits = fits && sort_wall_in(entries, &map->line[k], k, side_um);
    }
    for (uint32_t k = 0; k < map->corner_count; k++) {
        if (is_far(map->corner[k].p)) {
            return "a corner is farther from the origin than 1073 m";
        }
        const ale_tile_range_t tile = ale_tile_range_around(map->corner[k].p, 0, side_um);
        fits = fits && add_entry(entries, (entry_t){tile.first_x, tile.first_y, true, k});
    }
    if (!fits) {
        return "not enough memory";
    }
    if (entries->count > 0) {
        qsort(entries->at, entries->count, sizeof entries->at[0], compare);
    }
    return NULL;
}

/* Takes entries of one tile, from the first on; how many, or 0: they do not fit a map. */
static size_t fill_tile(const entries_t *entries, size_t first, const ale_whole_map_t *map, ale_map_t *tile)
{
    size_t k = first;
    tile->line_count = tile->corner_count = 0;
    for (; k < entries->count && entries->at[k].x == entries->at[first].x &&
           entries->at[k].y == entries->at[first].y;
         k++) {
        const entry_t *entry = &entries->at[k];
        if (tile->line_count == ALE_MAP_MAX_LINES || tile->corner_count == ALE_MAP_MAX_CORNERS) {
            return 0;
        }
        if (entry->is_corner) {
            tile->corner[tile->corner_count++] = map->corner[entry->index];
        } else {
            tile->line[tile->line_count] = map->line[entry->index];
            tile->line[tile->line_count++].id = entry->index + 1;
        }
    }
    return k - first;
}

/* The two parts of the file, in memory. */
typedef struct {
    FILE *index;
    FILE *tiles;
    char *index_text;
    char *tiles_text;
    size_t index_count;
    size_t tiles_count;
} parts_t;

static const char *write_tile(parts_t *parts, const entry_t *at, const ale_map_t *tile, uint64_t *written)
{
    size_t bytes = 0;
    char *text = ale_map_text_print(tile, NULL, &bytes);
    if (!text) {
        return "not enough memory";
    }
    fwrite(text, 1, bytes, parts->tiles);
    free(text);
    fprintf(parts->index, "tile %" PRId32 " %" PRId32 " %u %u %" PRIu64 " %zu\n", at->x, at->y,
            tile->line_count, tile->corner_count, *written, bytes);
    *written += bytes;
    return NULL;
}

static const char *write_tiles(parts_t *parts, const entries_t *entries, const ale_whole_map_t *map,
                               int32_t side_um)
{
    ale_map_t *tile = calloc(1, sizeof *tile);
    const char *wrong = tile ? NULL : "not enough memory";
    uint32_t count = 0;
    uint64_t written = 0;
    fprintf(parts->index, "ALE-SLAM tiles 1\n# map: side_um walls corners\nmap %" PRId32 " %zu %zu\n",
            side_um, map->line_count, map->corner_count);
    fprintf(parts->index, "# tile: x y walls corners first_byte bytes\n");
    for (size_t k = 0; !wrong && k < entries->count; count++) {
        const size_t taken = fill_tile(entries, k, map, tile);
        wrong = taken == 0 ? "more walls or corners in a tile than in a map: choose smaller tiles"
                           : write_tile(parts, &entries->at[k], tile, &written);
        k += taken;
    }
    free(tile);
    fflush(parts->index);
    const uint32_t crc = (uint32_t)crc32(0, (const Bytef *)parts->index_text, (uInt)parts->index_count);
    fprintf(parts->index, "end %" PRIu32 " %08" PRIx32 "\n", count, crc);
    return !wrong && count > ALE_TILES_MOST ? "too many tiles: choose larger ones" : wrong;
}

static bool close_parts(parts_t *parts)
{
    const bool index = parts->index && fclose(parts->index) == 0;
    return parts->tiles && fclose(parts->tiles) == 0 && index;
}

static const char *make_parts(parts_t *parts, const ale_whole_map_t *map, int32_t side_um)
{
    entries_t entries = {NULL, 0, 0};
    const char *wrong = sort_in(&entries, map, side_um);
    parts->index = open_memstream(&parts->index_text, &parts->index_count);
    parts->tiles = open_memstream(&parts->tiles_text, &parts->tiles_count);
    if (!wrong && parts->index && parts->tiles) {
        wrong = write_tiles(parts, &entries, map, side_um);
    }
    free(entries.at);
    return !close_parts(parts) && !wrong ? "not enough memory" : wrong;
}

static const char *write_parts(const char *path, const parts_t *parts)
{
    ale_whole_file_t file;
    if (ale_whole_file_begin(&file, path, RIGHTS) < 0) {
        return ale_whole_file_words(errno);
    }
    fwrite(parts->index_text, 1, parts->index_count, file.out);
    fwrite(parts->tiles_text, 1, parts->tiles_count, file.out);
    return ale_whole_file_commit(&file) < 0 ? ale_whole_file_words(errno) : NULL;
}

int ale_tile_file_save(const char *path, const ale_whole_map_t *map, int32_t side_um,
                       char error[ALE_MAP_FILE_ERROR])
{
    parts_t parts = {NULL, NULL, NULL, NULL, 0, 0};
    const bool is_side =
        side_um >= ALE_TILE_SIDE_LEAST_UM && side_um <= ALE_TILE_SIDE_MOST_UM && side_um % 1000 == 0;
    const char *wrong = is_side ? make_parts(&parts, map, side_um) : "tiles of this side there are not";
    if (!wrong) {
        wrong = write_parts(path, &parts);
    }
    free(parts.index_text);
    free(parts.tiles_text);
    if (wrong) {
        snprintf(error, ALE_MAP_FILE_ERROR, "%s: %s", path, wrong);
    }
    return wrong ? -1 : 0;
}
