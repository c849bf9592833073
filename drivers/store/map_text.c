#include "store/map_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <zlib.h>

#include "base/fixed.h"
#include "extract/features.h"
#include "file/text.h"

static const char HEAD[] = "ALE-SLAM map 1";
static const char WALL_LEGEND[] =
    "# wall: id start_x start_y end_x end_y var_alpha_nrad2 cov_um_nrad var_rho_um2 seen\n";
static const char CORNER_LEGEND[] = "# corner: x y var_xx var_xy var_yy angle_bam bisector_bam seen kind\n";

static const char POSE_LEGEND[] = "# pose: x y theta_bam\n";

enum { WALL_NUMBERS = 9, CORNER_NUMBERS = 9, POSE_NUMBERS = 3, ROUNDING = 16 };

static void print_wall(FILE *out, const ale_map_line_t *wall)
{
    fprintf(out, "wall %" PRIu32 " %" PRId32 " %" PRId32 " %" PRId32 " %" PRId32, wall->id, wall->start.x_um,
            wall->start.y_um, wall->end.x_um, wall->end.y_um);
    fprintf(out, " %" PRId64 " %" PRId64 " %" PRId64 " %" PRIu32 "\n", wall->var_alpha_nrad2,
            wall->cov_alpha_rho, wall->var_rho_um2, wall->seen);
}

static void print_corner(FILE *out, const ale_map_corner_t *corner)
{
    fprintf(out, "corner %" PRId32 " %" PRId32 " %" PRId64 " %" PRId64 " %" PRId64, corner->p.x_um,
            corner->p.y_um, corner->cov_um2[0], corner->cov_um2[1], corner->cov_um2[2]);
    fprintf(out, " %" PRIu32 " %" PRIu32 " %" PRIu32 " %u\n", corner->angle_bam, corner->bisector_bam,
            corner->seen, corner->kind);
}

char *ale_map_text_print(const ale_map_t *map, const ale_pose_t *pose, size_t *count)
{
    char *text = NULL;
    FILE *out = open_memstream(&text, count);
    if (!out) {
        return NULL;
    }
    fprintf(out, "%s\n%s%s", HEAD, WALL_LEGEND, CORNER_LEGEND);
    for (uint32_t i = 0; i < map->line_count; i++) {
        print_wall(out, &map->line[i]);
    }
    for (uint32_t i = 0; i < map->corner_count; i++) {
        print_corner(out, &map->corner[i]);
    }
    if (pose) {
        fprintf(out, "%spose %" PRId32 " %" PRId32 " %" PRIu32 "\n", POSE_LEGEND, pose->x_um, pose->y_um,
                pose->theta_bam);
    }
    fflush(out);
    const uint32_t crc = (uint32_t)crc32(0, (const Bytef *)text, (uInt)*count);
    fprintf(out, "end %u %08" PRIx32 "\n", (unsigned)map->line_count + map->corner_count, crc);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

/* The distance of any two points of a map fits 32 bits. */
static bool is_length(int64_t value)
{
    return value >= -ALE_MAP_FARTHEST_UM && value <= ALE_MAP_FARTHEST_UM;
}

/* Variances and the covariance between: positive but for rounding. What is far from it no map has, and the
 * matching's sums do not hold it. */
static bool is_covariance(int64_t var_a, int64_t cov, int64_t var_b)
{
    const int64_t most_var_um2 = INT64_C(1000000000000000000); /* of a length: 1 km */
    const int64_t most_cov = INT64_MAX / 4;
    if (var_a < 0 || var_b < 0 || var_b > most_var_um2 || cov < -most_cov || cov > most_cov) {
        return false;
    }
    const int64_t limit =
        ((int64_t)ale_isqrt((uint64_t)var_a) + 1) * ((int64_t)ale_isqrt((uint64_t)var_b) + 1);
    return ale_abs64(cov / ROUNDING) <= limit;
}

static bool is_word32(int64_t value)
{
    return value >= 0 && value <= UINT32_MAX;
}

static bool take_wall(ale_span_t line, ale_map_t *map)
{
    int64_t n[WALL_NUMBERS];
    if (map->line_count >= ALE_MAP_MAX_LINES || !ale_text_numbers(line, n, WALL_NUMBERS) ||
        !is_word32(n[0]) || !is_length(n[1]) || !is_length(n[2]) || !is_length(n[3]) || !is_length(n[4]) ||
        !is_covariance(n[5], n[6], n[7]) || !is_word32(n[8])) {
        return false;
    }
    map->line[map->line_count++] = (ale_map_line_t){.id = (uint32_t)n[0],
                                                    .start = {(int32_t)n[1], (int32_t)n[2]},
                                                    .end = {(int32_t)n[3], (int32_t)n[4]},
                                                    .var_alpha_nrad2 = n[5],
                                                    .cov_alpha_rho = n[6],
                                                    .var_rho_um2 = n[7],
                                                    .seen = (uint32_t)n[8]};
    return true;
}

static bool take_corner(ale_span_t line, ale_map_t *map)
{
    int64_t n[CORNER_NUMBERS];
    if (map->corner_count >= ALE_MAP_MAX_CORNERS || !ale_text_numbers(line, n, CORNER_NUMBERS) ||
        !is_length(n[0]) || !is_length(n[1]) || !is_covariance(n[2], n[3], n[4]) ||
        !is_covariance(n[4], n[3], n[2]) || !is_word32(n[5]) || !is_word32(n[6]) || !is_word32(n[7]) ||
        n[8] < ALE_CORNER_CONVEX || n[8] > ALE_CORNER_CONCAVE) {
        return false;
    }
    map->corner[map->corner_count++] = (ale_map_corner_t){.p = {(int32_t)n[0], (int32_t)n[1]},
                                                          .cov_um2 = {n[2], n[3], n[4]},
                                                          .angle_bam = (uint32_t)n[5],
                                                          .bisector_bam = (uint32_t)n[6],
                                                          .seen = (uint32_t)n[7],
                                                          .kind = (uint8_t)n[8]};
    return true;
}

static bool take_pose(ale_span_t line, ale_map_text_t *content)
{
    int64_t n[POSE_NUMBERS];
    if (content->pose_known || !ale_text_numbers(line, n, POSE_NUMBERS) || !is_length(n[0]) ||
        !is_length(n[1]) || !is_word32(n[2])) {
        return false;
    }
    content->pose = (ale_pose_t){(int32_t)n[0], (int32_t)n[1], (uint32_t)n[2]};
    content->pose_known = true;
    return true;
}

static bool is_right_end(ale_span_t line, const ale_map_t *map, const uint8_t *at, const char *end_line)
{
    char expected[32];
    const uint32_t crc = (uint32_t)crc32(0, at, (uInt)(end_line - (const char *)at));
    snprintf(expected, sizeof expected, "%08" PRIx32, crc);
    ale_span_t word;
    int64_t count = 0;
    return ale_text_word(&line, &word) && ale_text_decimal(word, 0, &count) &&
           count == (int64_t)map->line_count + map->corner_count && ale_text_word(&line, &word) &&
           ale_text_is(word, expected);
}

typedef enum { LINE_TAKEN, LINE_WRONG, LINE_ENDS_MAP } line_outcome_t;

static line_outcome_t take_line(ale_span_t line, const uint8_t *at, ale_map_text_t *content)
{
    ale_map_t *map = &content->map;
    const char *begin = line.at;
    ale_span_t word;
    if (!ale_text_word(&line, &word) || *word.at == '#') {
        return LINE_TAKEN;
    }
    if (ale_text_is(word, "wall")) {
        return take_wall(line, map) ? LINE_TAKEN : LINE_WRONG;
    }
    if (ale_text_is(word, "corner")) {
        return take_corner(line, map) ? LINE_TAKEN : LINE_WRONG;
    }
    if (ale_text_is(word, "pose")) {
        return take_pose(line, content) ? LINE_TAKEN : LINE_WRONG;
    }
    return ale_text_is(word, "end") && is_right_end(line, map, at, begin) ? LINE_ENDS_MAP : LINE_WRONG;
}

const char *ale_map_text_parse(const uint8_t *at, size_t count, ale_map_text_t *content,
                               uint64_t *line_number)
{
    ale_text_t text = ale_text(at, count);
    ale_span_t line;
    if (!ale_text_line(&text, &line) || !ale_text_is(line, HEAD)) {
        return "not a map of version 1";
    }
    while (ale_text_line(&text, &line)) {
        *line_number = text.line;
        const line_outcome_t outcome = take_line(line, at, content);
        if (outcome == LINE_ENDS_MAP) {
            return NULL;
        }
        if (outcome == LINE_WRONG) {
            return "damaged or too large";
        }
    }
    return "cut short";
}
