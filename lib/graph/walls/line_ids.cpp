#include "graph/walls/line_ids.h"

#include <algorithm>
#include <iterator>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "observe/observation.h"
}

namespace ale
{

namespace
{

constexpr int64_t beside_um = 150000;
constexpr int64_t parallel_bam = int64_t{10} * ALE_BAM_PER_DEGREE;

struct Claim {
    int64_t overlap_um;
    size_t last;
    uint16_t line;
};

} // namespace

LineIds::Line LineIds::line_of(const ale_map_line_t &line)
{
    const ale_point_t d = ale_minus(line.end, line.start);
    return {line, ale_atan2_bam(d.y_um, d.x_um)};
}

// Length of `line` that lies on `last`; 0: another wall.
int64_t LineIds::overlap_um(const Line &last, const Line &line)
{
    if (ale_abs64(ale_bam_diff(last.along_bam, line.along_bam)) > parallel_bam) {
        return 0;
    }
    const ale_point_t from = ale_minus(line.line.start, last.line.start);
    const ale_point_t to = ale_minus(line.line.end, last.line.start);
    const uint32_t across_bam = last.along_bam + ALE_BAM_QUARTER_TURN;
    const int64_t aside_um = (ale_along(from, across_bam) + ale_along(to, across_bam)) / 2;
    const int64_t length_um = ale_along(ale_minus(last.line.end, last.line.start), last.along_bam);
    const int64_t first_um = ale_max64(0, ale_along(from, last.along_bam));
    const int64_t end_um = ale_min64(length_um, ale_along(to, last.along_bam));
    return ale_abs64(aside_um) < beside_um ? ale_max64(end_um - first_um, 0) : 0;
}

void LineIds::assign(ale_map_t *map)
{
    std::vector<Line> now;
    std::transform(map->line, map->line + map->line_count, std::back_inserter(now), line_of);
    std::vector<Claim> claims;
    for (uint16_t line = 0; line < map->line_count; line++) {
        for (size_t last = 0; last < last_.size(); last++) {
            const int64_t overlap = overlap_um(last_[last], now[line]);
            if (overlap > 0) {
                claims.push_back({overlap, last, line});
            }
        }
    }
    std::stable_sort(claims.begin(), claims.end(),
                     [](const Claim &a, const Claim &b) { return a.overlap_um > b.overlap_um; });
    std::vector<bool> has_id(map->line_count, false);
    std::vector<bool> taken(last_.size(), false);
    for (const Claim &claim : claims) {
        if (!has_id[claim.line] && !taken[claim.last]) {
            now[claim.line].line.id = last_[claim.last].line.id;
            has_id[claim.line] = taken[claim.last] = true;
        }
    }
    for (uint16_t line = 0; line < map->line_count; line++) {
        if (!has_id[line]) {
            now[line].line.id = next_++;
        }
        map->line[line].id = now[line].line.id;
    }
    last_ = std::move(now);
}

} // namespace ale
