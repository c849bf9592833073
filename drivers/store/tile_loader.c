#include "store/tile_loader.h"

#include <stdlib.h>
#include <string.h>

#include "base/fixed.h"

/* A wall that the map in work has been given. */
typedef struct {
    uint32_t id;
    ale_point_t start;
    ale_point_t end;
} given_t;

struct ale_tile_loader {
    ale_tile_file_t file;
    ale_tile_trouble_t trouble;
    uint32_t epoch;         /* 0: of none yet */
    uint32_t unread_before; /* this epoch */
    ale_tile_range_t range;
    given_t given[ALE_TILE_WALLS];
    uint16_t given_count;
    ale_map_t tile; /* that is read */

    /* What the last call of follow has found, and how much of it has been handed out. */
    bool found;
    uint32_t due;
    uint32_t gone[ALE_TILE_WALLS];
    ale_map_line_t line[ALE_TILE_WALLS];
    ale_map_corner_t corner[ALE_TILE_CORNERS];
    uint16_t gone_count, gone_taken;
    uint16_t line_count, line_taken;
    uint16_t corner_count, corner_taken;
};

static const ale_tile_range_t NOWHERE = {0, 0, -1, -1};

ale_tile_loader_t *ale_tile_loader_open(const char *path, char error[ALE_MAP_FILE_ERROR])
{
    ale_tile_loader_t *loader = calloc(1, sizeof *loader);
    if (!loader) {
        snprintf(error, ALE_MAP_FILE_ERROR, "%s: not enough memory", path);
        return NULL;
    }
    if (ale_tile_file_open(&loader->file, path, error) < 0) {
        free(loader);
        return NULL;
    }
    loader->range = NOWHERE;
    return loader;
}

void ale_tile_loader_close(ale_tile_loader_t *loader)
{
    if (loader) {
        ale_tile_file_close(&loader->file);
        free(loader);
    }
}

const ale_tile_file_t *ale_tile_loader_file(const ale_tile_loader_t *loader)
{
    return &loader->file;
}

const ale_tile_trouble_t *ale_tile_loader_trouble(const ale_tile_loader_t *loader)
{
    return &loader->trouble;
}

/* Whether what the index counts in a range has room. */
static bool has_room_for(const ale_tile_file_t *file, ale_tile_range_t range)
{
    uint32_t walls = 0;
    uint32_t corners = 0;
    for (int32_t y = range.first_y; y <= range.last_y; y++) {
        for (int32_t x = range.first_x; x <= range.last_x; x++) {
            const ale_tile_entry_t *tile = ale_tile_file_find(file, x, y);
            walls += tile ? tile->walls : 0;
            corners += tile ? tile->corners : 0;
        }
    }
    return walls <= ALE_TILE_WALLS && corners <= ALE_TILE_CORNERS;
}

/* The largest range that has room: all within reach, or less. */
static ale_tile_range_t next_range(ale_tile_loader_t *loader, const ale_whereabouts_t *whereabouts)
{
    const int32_t side_um = loader->file.side_um;
    const ale_point_t place = {whereabouts->pose.x_um, whereabouts->pose.y_um};
    int64_t reach_um = whereabouts->reach_um;
    loader->trouble.wanted_um = reach_um;
    for (; reach_um > 0; reach_um -= side_um / 2) {
        const ale_tile_range_t range =
            ale_tile_range_follow(loader->range, place, reach_um, reach_um + side_um / 2, side_um);
        if (has_room_for(&loader->file, range)) {
            loader->trouble.reach_um = reach_um;
            return range;
        }
    }
    loader->trouble.reach_um = 0;
    return ale_tile_range_around(place, 0, side_um);
}

static int ascending(const void *left, const void *right)
{
    const uint32_t a = *(const uint32_t *)left;
    const uint32_t b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

/* Walls that no tile of the range holds go. */
static void let_go(ale_tile_loader_t *loader, ale_tile_range_t range)
{
    const ale_box_t box = ale_tile_range_box(range, loader->file.side_um);
    uint16_t kept = 0;
    for (uint16_t k = 0; k < loader->given_count; k++) {
        const given_t *wall = &loader->given[k];
        if (ale_box_touches(&box, wall->start, wall->end)) {
            loader->given[kept++] = *wall;
        } else {
            loader->gone[loader->gone_count++] = wall->id;
        }
    }
    loader->given_count = kept;
    qsort(loader->gone, loader->gone_count, sizeof loader->gone[0], ascending);
}

static bool is_given(const ale_tile_loader_t *loader, uint32_t id)
{
    for (uint16_t k = 0; k < loader->given_count; k++) {
        if (loader->given[k].id == id) {
            return true;
        }
    }
    return false;
}

static void give_wall(ale_tile_loader_t *loader, const ale_map_line_t *line)
{
    if (line->id == 0 || is_given(loader, line->id)) {
        return;
    }
    if (loader->given_count == ALE_TILE_WALLS) {
        loader->trouble.refused++;
        return;
    }
    loader->given[loader->given_count++] = (given_t){line->id, line->start, line->end};
    loader->line[loader->line_count++] = *line;
}

static void give_tile(ale_tile_loader_t *loader, const ale_tile_entry_t *entry)
{
    if (ale_tile_file_read(&loader->file, entry, &loader->tile, loader->trouble.error) < 0) {
        loader->trouble.unread++;
        return;
    }
    for (uint16_t k = 0; k < loader->tile.line_count; k++) {
        give_wall(loader, &loader->tile.line[k]);
    }
    for (uint16_t k = 0; k < loader->tile.corner_count; k++) {
        if (loader->corner_count == ALE_TILE_CORNERS) {
            loader->trouble.refused++;
        } else {
            loader->corner[loader->corner_count++] = loader->tile.corner[k];
        }
    }
}

static void give_range(ale_tile_loader_t *loader, ale_tile_range_t range)
{
    for (int32_t y = range.first_y; y <= range.last_y; y++) {
        for (int32_t x = range.first_x; x <= range.last_x; x++) {
            const ale_tile_entry_t *entry = ale_tile_file_find(&loader->file, x, y);
            if (entry && !ale_tile_range_has(loader->range, x, y)) {
                give_tile(loader, entry);
            }
        }
    }
}

static void begin_epoch(ale_tile_loader_t *loader, uint32_t epoch)
{
    loader->epoch = epoch;
    loader->range = NOWHERE;
    loader->given_count = 0;
    loader->due = 0;
    loader->unread_before = loader->trouble.unread;
}

void ale_tile_loader_follow(ale_tile_loader_t *loader, const ale_whereabouts_t *whereabouts)
{
    if (whereabouts->epoch != loader->epoch) {
        begin_epoch(loader, whereabouts->epoch);
    }
    loader->gone_count = loader->gone_taken = 0;
    loader->line_count = loader->line_taken = 0;
    loader->corner_count = loader->corner_taken = 0;
    const ale_tile_range_t range = next_range(loader, whereabouts);
    loader->found = !ale_tile_range_equals(range, loader->range);
    if (loader->found) {
        const uint32_t due = whereabouts->scan + ALE_TILE_DELAY_SCANS;
        loader->due = due > loader->due ? due : loader->due; /* one piece a scan */
        let_go(loader, range);
        give_range(loader, range);
        loader->range = range;
    }
}

static bool has_whole_map(const ale_tile_loader_t *loader)
{
    bool whole = loader->trouble.unread == loader->unread_before && loader->trouble.refused == 0;
    for (uint32_t k = 0; k < loader->file.count && whole; k++) {
        whole = ale_tile_range_has(loader->range, loader->file.tile[k].x, loader->file.tile[k].y);
    }
    return whole;
}

/* How many of what is left go into a piece. */
static uint16_t part(uint16_t count, uint16_t taken, uint16_t most)
{
    return (uint16_t)ale_min64(count - taken, most);
}

bool ale_tile_loader_next(ale_tile_loader_t *loader, ale_tile_change_t *out)
{
    if (!loader->found) {
        return false;
    }
    out->epoch = loader->epoch;
    out->due = loader->due++;
    out->gone_count = part(loader->gone_count, loader->gone_taken, ALE_TILE_PIECE_WALLS);
    out->line_count = part(loader->line_count, loader->line_taken, ALE_TILE_PIECE_WALLS);
    out->corner_count = part(loader->corner_count, loader->corner_taken, ALE_TILE_PIECE_CORNERS);
    memcpy(out->gone, &loader->gone[loader->gone_taken], out->gone_count * sizeof out->gone[0]);
    memcpy(out->line, &loader->line[loader->line_taken], out->line_count * sizeof out->line[0]);
    memcpy(out->corner, &loader->corner[loader->corner_taken], out->corner_count * sizeof out->corner[0]);
    loader->gone_taken = (uint16_t)(loader->gone_taken + out->gone_count);
    loader->line_taken = (uint16_t)(loader->line_taken + out->line_count);
    loader->corner_taken = (uint16_t)(loader->corner_taken + out->corner_count);
    out->last = loader->gone_taken == loader->gone_count && loader->line_taken == loader->line_count &&
                loader->corner_taken == loader->corner_count;
    out->window = ale_tile_range_box(loader->range, loader->file.side_um);
    out->whole = out->last && has_whole_map(loader);
    loader->found = !out->last;
    return true;
}
