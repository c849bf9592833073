#include "common/export/map_tidy.h"

#include "base/fixed.h"
#include "base/trig.h"

/* A line of the map as a middle, a direction and half a length. */
typedef struct {
    ale_point_t middle;
    uint32_t along_bam;
    int64_t half_um;
    int64_t evidence; /* scans that saw it, times its length in mm */
} segment_t;

static segment_t segment_of(const ale_map_line_t *line)
{
    const int64_t dx = (int64_t)line->end.x_um - line->start.x_um;
    const int64_t dy = (int64_t)line->end.y_um - line->start.y_um;
    const int64_t length_um = ale_isqrt((uint64_t)(dx * dx + dy * dy));
    return (segment_t){.middle = {(int32_t)ale_round_div((int64_t)line->start.x_um + line->end.x_um, 2),
                                  (int32_t)ale_round_div((int64_t)line->start.y_um + line->end.y_um, 2)},
                       .along_bam = ale_atan2_bam(dy, dx),
                       .half_um = length_um / 2,
                       .evidence = (1 + length_um / 1000) * (1 + (int64_t)line->seen)};
}

/* A point in the frame of a segment: x along it, y across, from its middle. */
static ale_point_t seen_from(const segment_t *segment, ale_point_t p)
{
    return ale_rotate((ale_point_t){p.x_um - segment->middle.x_um, p.y_um - segment->middle.y_um},
                      0u - segment->along_bam);
}

static bool is_beside(ale_point_t p)
{
    return ale_abs64(p.y_um) < ALE_TIDY_OFFSET_UM;
}

/* The shorter line lies beside the longer one, along at least half of its own length. */
static bool show_one_wall(const ale_map_line_t *a, const ale_map_line_t *b)
{
    const segment_t sa = segment_of(a);
    const segment_t sb = segment_of(b);
    const int64_t apart_um = sa.half_um + sb.half_um + ALE_TIDY_OFFSET_UM;
    if (a->map_id != b->map_id || ale_abs64((int64_t)sa.middle.x_um - sb.middle.x_um) > apart_um ||
        ale_abs64((int64_t)sa.middle.y_um - sb.middle.y_um) > apart_um ||
        ale_abs64(ale_bam_diff(sa.along_bam, sb.along_bam)) >
            (int64_t)ALE_TIDY_ANGLE_MRAD * ALE_BAM_PER_MRAD) {
        return false;
    }
    const bool a_longer = sa.half_um >= sb.half_um;
    const segment_t *longer = a_longer ? &sa : &sb;
    const ale_map_line_t *shorter = a_longer ? b : a;
    const ale_point_t start = seen_from(longer, shorter->start);
    const ale_point_t end = seen_from(longer, shorter->end);
    const int64_t common_um = ale_min64(longer->half_um, end.x_um) - ale_max64(-longer->half_um, start.x_um);
    return is_beside(start) && is_beside(end) && 2 * common_um >= (int64_t)end.x_um - start.x_um;
}

static int32_t mean(int64_t a, int64_t weight_a, int64_t b, int64_t weight_b)
{
    return (int32_t)(a + ale_mul_div(b - a, weight_b, weight_a + weight_b));
}

/* Reaches from the farthest start to the farthest end, at the mean place and direction by evidence. */
static void join(ale_map_line_t *keep, const ale_map_line_t *other)
{
    const segment_t a = segment_of(keep);
    const segment_t b = segment_of(other);
    const int64_t turn_bam = ale_bam_diff(b.along_bam, a.along_bam);
    const segment_t joint = {
        .middle = {mean(a.middle.x_um, a.evidence, b.middle.x_um, b.evidence),
                   mean(a.middle.y_um, a.evidence, b.middle.y_um, b.evidence)},
        .along_bam = a.along_bam + (uint32_t)ale_mul_div(turn_bam, b.evidence, a.evidence + b.evidence)};
    const int64_t from_um =
        ale_min64(seen_from(&joint, keep->start).x_um, seen_from(&joint, other->start).x_um);
    const int64_t to_um = ale_max64(seen_from(&joint, keep->end).x_um, seen_from(&joint, other->end).x_um);
    const ale_pose_t frame = {joint.middle.x_um, joint.middle.y_um, joint.along_bam};
    if (b.evidence > a.evidence) {
        keep->id = other->id;
        keep->var_alpha_nrad2 = other->var_alpha_nrad2;
        keep->cov_alpha_rho = other->cov_alpha_rho;
        keep->var_rho_um2 = other->var_rho_um2;
    }
    keep->seen += other->seen;
    keep->start = ale_pose_apply(frame, (ale_point_t){(int32_t)from_um, 0});
    keep->end = ale_pose_apply(frame, (ale_point_t){(int32_t)to_um, 0});
}

static void remove_line(ale_map_t *map, uint16_t index)
{
    map->line_count--;
    for (uint16_t k = index; k < map->line_count; k++) {
        map->line[k] = map->line[k + 1];
    }
}

/* Joins the first line after `index` that shows the same wall. */
static bool join_one(ale_map_t *map, uint16_t index)
{
    for (uint16_t k = (uint16_t)(index + 1); k < map->line_count; k++) {
        if (show_one_wall(&map->line[index], &map->line[k])) {
            join(&map->line[index], &map->line[k]);
            remove_line(map, k);
            return true;
        }
    }
    return false;
}

void ale_map_tidy(ale_map_t *map)
{
    /* Every join takes a line away, so this ends. A joined line may now reach an earlier one. */
    bool joined = true;
    for (uint16_t pass = 0; joined && pass < ALE_MAP_MAX_LINES; pass++) {
        joined = false;
        for (uint16_t k = 0; k < map->line_count; k++) {
            while (join_one(map, k)) {
                joined = true;
            }
        }
    }
}
