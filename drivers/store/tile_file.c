#include "store/tile_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/fixed.h"
#include "file/bytes.h"
#include "file/text.h"

static const char HEAD[] = "ALE-SLAM tiles 1";

enum { MAP_NUMBERS = 3, TILE_NUMBERS = 6, LINE_BYTES = 160, GROWTH = 1024 };

static int fail(char error[ALE_MAP_FILE_ERROR], const char *path, const char *reason)
{
    snprintf(error, ALE_MAP_FILE_ERROR, "%s: %s", path, reason);
    return -1;
}

/* NULL, or what is wrong. */
static const char *open_tiles(FILE **in, const char *path)
{
    const ale_bytes_rule_t rule = {.most = SIZE_MAX, .follow_links = false};
    struct stat status;
    int descriptor;
    const char *wrong = ale_bytes_open_regular(&descriptor, path, &rule, &status);
    if (wrong) {
        return wrong;
    }
    *in = fdopen(descriptor, "rb");
    if (!*in) {
        close(descriptor);
        return "not enough memory";
    }
    return NULL;
}

/* From the first byte on, and back to it. */
static bool has_head(FILE *in)
{
    char head[sizeof HEAD];
    const bool is_head = fread(head, 1, sizeof head, in) == sizeof head &&
                         memcmp(head, HEAD, sizeof HEAD - 1) == 0 && head[sizeof HEAD - 1] == '\n';
    rewind(in);
    return is_head;
}

bool ale_tile_file_is(const char *path)
{
    FILE *in;
    if (open_tiles(&in, path)) {
        return false;
    }
    const bool is_head = has_head(in);
    fclose(in);
    return is_head;
}

static bool is_within(int64_t value, int64_t least, int64_t most)
{
    return value >= least && value <= most;
}

static bool take_map(ale_tile_file_t *file, ale_span_t line)
{
    int64_t n[MAP_NUMBERS];
    if (file->side_um != 0 || !ale_text_numbers(line, n, MAP_NUMBERS) ||
        !is_within(n[0], ALE_TILE_SIDE_LEAST_UM, ALE_TILE_SIDE_MOST_UM) || n[0] % 1000 != 0 ||
        !is_within(n[1], 0, UINT32_MAX) || !is_within(n[2], 0, UINT32_MAX)) {
        return false;
    }
    file->side_um = (int32_t)n[0];
    file->walls = (uint32_t)n[1];
    file->corners = (uint32_t)n[2];
    return true;
}

/* Room for one more; the last place is then free. */
static bool has_room(ale_tile_file_t *file)
{
    if (file->count % GROWTH != 0) {
        return true;
    }
    ale_tile_entry_t *more = realloc(file->tile, (file->count + GROWTH) * sizeof *more);
    if (!more) {
        return false;
    }
    file->tile = more;
    return true;
}

static int order(int32_t ax, int32_t ay, const ale_tile_entry_t *b)
{
    return ay != b->y ? (ay < b->y ? -1 : 1) : (ax > b->x) - (ax < b->x);
}

static bool take_tile(ale_tile_file_t *file, ale_span_t line)
{
    int64_t n[TILE_NUMBERS];
    const int32_t farthest = ALE_MAP_FARTHEST_UM / ALE_TILE_SIDE_LEAST_UM + 1;
    if (file->count == ALE_TILES_MOST || !ale_text_numbers(line, n, TILE_NUMBERS) ||
        !is_within(n[0], -farthest, farthest) || !is_within(n[1], -farthest, farthest) ||
        !is_within(n[2], 0, ALE_MAP_MAX_LINES) || !is_within(n[3], 0, ALE_MAP_MAX_CORNERS) ||
        !is_within(n[4], 0, INT64_MAX / 2) || !is_within(n[5], 1, ALE_MAP_TEXT_MOST)) {
        return false;
    }
    const bool ascends =
        file->count == 0 || order((int32_t)n[0], (int32_t)n[1], &file->tile[file->count - 1]) > 0;
    if (!ascends || !has_room(file)) {
        return false;
    }
    file->tile[file->count++] = (ale_tile_entry_t){.x = (int32_t)n[0],
                                                   .y = (int32_t)n[1],
                                                   .first_byte = (uint64_t)n[4],
                                                   .bytes = (uint32_t)n[5],
                                                   .walls = (uint16_t)n[2],
                                                   .corners = (uint16_t)n[3]};
    return true;
}

static bool is_right_end(const ale_tile_file_t *file, ale_span_t line, uint32_t crc)
{
    char expected[16];
    ale_span_t word;
    int64_t count = 0;
    snprintf(expected, sizeof expected, "%08" PRIx32, crc);
    return file->side_um != 0 && ale_text_word(&line, &word) && ale_text_decimal(word, 0, &count) &&
           count == file->count && ale_text_word(&line, &word) && ale_text_is(word, expected);
}

typedef enum { LINE_TAKEN, LINE_WRONG, LINE_ENDS_INDEX } line_outcome_t;

static line_outcome_t take_line(ale_tile_file_t *file, ale_span_t line, uint32_t crc)
{
    ale_span_t word;
    if (!ale_text_word(&line, &word) || *word.at == '#') {
        return LINE_TAKEN;
    }
    if (ale_text_is(word, "map")) {
        return take_map(file, line) ? LINE_TAKEN : LINE_WRONG;
    }
    if (ale_text_is(word, "tile")) {
        return take_tile(file, line) ? LINE_TAKEN : LINE_WRONG;
    }
    return ale_text_is(word, "end") && is_right_end(file, line, crc) ? LINE_ENDS_INDEX : LINE_WRONG;
}

/* NULL, or what is wrong. The first line is known. */
static const char *read_index(ale_tile_file_t *file, uint64_t *line_number)
{
    char text[LINE_BYTES];
    uint32_t crc = (uint32_t)crc32(0, NULL, 0);
    while (fgets(text, sizeof text, file->in)) {
        const size_t count = strlen(text);
        ++*line_number;
        if (count == 0 || text[count - 1] != '\n') {
            break;
        }
        const ale_span_t line = {text, text + count - 1};
        const line_outcome_t outcome = *line_number == 1 ? LINE_TAKEN : take_line(file, line, crc);
        if (outcome != LINE_TAKEN) {
            file->index_bytes += count;
            return outcome == LINE_ENDS_INDEX ? NULL : "damaged or too large";
        }
        crc = (uint32_t)crc32(crc, (const Bytef *)text, (uInt)count);
        file->index_bytes += count;
    }
    return "cut short or damaged";
}

int ale_tile_file_open(ale_tile_file_t *file, const char *path, char error[ALE_MAP_FILE_ERROR])
{
    uint64_t line_number = 0;
    *file = (ale_tile_file_t){0};
    const char *wrong = open_tiles(&file->in, path);
    if (!wrong && !has_head(file->in)) {
        wrong = "not a map of tiles of version 1";
    }
    if (!wrong) {
        wrong = read_index(file, &line_number);
    }
    if (!wrong) {
        return 0;
    }
    ale_tile_file_close(file);
    if (line_number > 0) {
        snprintf(error, ALE_MAP_FILE_ERROR, "%s: line %" PRIu64 ": %s", path, line_number, wrong);
        return -1;
    }
    return fail(error, path, wrong);
}

void ale_tile_file_close(ale_tile_file_t *file)
{
    if (file->in) {
        fclose(file->in);
    }
    free(file->tile);
    *file = (ale_tile_file_t){0};
}

const ale_tile_entry_t *ale_tile_file_find(const ale_tile_file_t *file, int32_t x, int32_t y)
{
    uint32_t low = 0;
    uint32_t high = file->count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        const int side = order(x, y, &file->tile[middle]);
        if (side == 0) {
            return &file->tile[middle];
        }
        low = side > 0 ? middle + 1 : low;
        high = side < 0 ? middle : high;
    }
    return NULL;
}

/* The tile's bytes as they lie in the file: as many as there are, up to `most`. */
static const char *read_bytes(const ale_tile_file_t *file, const ale_tile_entry_t *tile, uint8_t *bytes)
{
    size_t count = 0;
    while (count < tile->bytes) {
        const off_t at = (off_t)(file->index_bytes + tile->first_byte + count);
        const ssize_t more = pread(fileno(file->in), bytes + count, tile->bytes - count, at);
        if (more < 0 && errno != EINTR) {
            return strerror(errno);
        }
        if (more == 0) {
            return "cut short";
        }
        count += more > 0 ? (size_t)more : 0;
    }
    return NULL;
}

int ale_tile_file_read(const ale_tile_file_t *file, const ale_tile_entry_t *tile, ale_map_t *out,
                       char error[ALE_MAP_FILE_ERROR])
{
    uint64_t line_number = 0;
    uint8_t *bytes = malloc(tile->bytes);
    ale_map_text_t *content = calloc(1, sizeof *content);
    const char *wrong = bytes && content ? read_bytes(file, tile, bytes) : "not enough memory";
    if (!wrong) {
        wrong = ale_map_text_parse(bytes, tile->bytes, content, &line_number);
    }
    if (!wrong && (content->map.line_count != tile->walls || content->map.corner_count != tile->corners)) {
        wrong = "another tile than the index says";
    }
    if (!wrong) {
        *out = content->map;
    }
    free(bytes);
    free(content);
    if (wrong) {
        snprintf(error, ALE_MAP_FILE_ERROR, "tile %" PRId32 " %" PRId32 ": %s", tile->x, tile->y, wrong);
    }
    return wrong ? -1 : 0;
}
