#include "lab/merge/map_changes.h"

#include <algorithm>
#include <cstddef>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "map/map_exchange.h"
#include "map/wall.h"
}

namespace merge
{

namespace
{

constexpr int64_t cell_um = 50000;
constexpr int64_t least_um = 200000; /* ends of walls differ by less from drive to drive */
constexpr int64_t beside_um = 80000;
constexpr int64_t beyond_end_um = 100000;
constexpr int64_t alike_bam = int64_t{15} * ALE_BAM_PER_DEGREE;
constexpr int64_t alike_length_um = 150000; /* and a quarter of the longer */
constexpr int64_t moved_um = 2000000;

/* Part of a wall. */
struct Stretch {
    ale_point_t start;
    ale_point_t end;
    uint32_t normal_bam;
    int64_t length_um;
    bool is_most; /* of its wall */
};

std::vector<ale_wall_t> walls_of_map(const ale_map_t &map)
{
    std::vector<ale_wall_t> walls;
    for (uint32_t k = 0; k < map.line_count; k++) {
        ale_wall_t wall;
        if (ale_map_line_wall(&map.line[k], &wall)) {
            walls.push_back(wall);
        }
    }
    return walls;
}

bool face_alike(uint32_t a_bam, uint32_t b_bam)
{
    return ale_abs64(ale_bam_diff(a_bam, b_bam)) < alike_bam;
}

bool stands_at(const std::vector<ale_wall_t> &walls, ale_point_t p, uint32_t normal_bam)
{
    return std::any_of(walls.begin(), walls.end(), [&](const ale_wall_t &wall) {
        const int64_t t_um = ale_wall_along(&wall, p);
        return face_alike(wall.normal_bam, normal_bam) && t_um > wall.start_um - beyond_end_um &&
               t_um < wall.end_um + beyond_end_um && ale_abs64(ale_wall_offset(&wall, p)) < beside_um;
    });
}

/* Runs of cells that the others do not show. */
void add_stretches(const ale_wall_t &wall, const std::vector<ale_wall_t> &others,
                   std::vector<Stretch> *stretches)
{
    int64_t from_um = wall.start_um;
    for (int64_t t_um = wall.start_um; t_um <= wall.end_um; t_um += cell_um) {
        const bool is_beyond = t_um + cell_um > wall.end_um;
        const int64_t next_um = is_beyond ? wall.end_um : t_um + cell_um;
        const bool stands = stands_at(others, ale_wall_point(&wall, (t_um + next_um) / 2), wall.normal_bam);
        const int64_t to_um = stands ? t_um : next_um;
        if ((stands || is_beyond) && to_um - from_um >= least_um) {
            stretches->push_back({ale_wall_point(&wall, from_um), ale_wall_point(&wall, to_um),
                                  wall.normal_bam, to_um - from_um,
                                  4 * (to_um - from_um) >= 3 * (int64_t{wall.end_um} - wall.start_um)});
        }
        from_um = stands ? next_um : from_um;
    }
}

std::vector<Stretch> only_in(const std::vector<ale_wall_t> &walls, const std::vector<ale_wall_t> &others)
{
    std::vector<Stretch> stretches;
    for (const ale_wall_t &wall : walls) {
        add_stretches(wall, others, &stretches);
    }
    return stretches;
}

/* Square of the distance between the middles. */
int64_t apart_um2(const Stretch &a, const Stretch &b)
{
    const int64_t dx = (int64_t{a.start.x_um} + a.end.x_um - b.start.x_um - b.end.x_um) / 2;
    const int64_t dy = (int64_t{a.start.y_um} + a.end.y_um - b.start.y_um - b.end.y_um) / 2;
    return dx * dx + dy * dy;
}

/* What continues a wall that stands, behind a cupboard for instance, was not moved there. */
bool may_be_one(const Stretch &a, const Stretch &b)
{
    return a.is_most && b.is_most && face_alike(a.normal_bam, b.normal_bam) &&
           apart_um2(a, b) < moved_um * moved_um &&
           ale_abs64(a.length_um - b.length_um) <= alike_length_um + std::max(a.length_um, b.length_um) / 4;
}

/* One that is gone and one that is new. */
struct Pair {
    size_t gone;
    size_t added;
    int64_t apart_um2;
};

std::vector<Pair> pairs_of(const std::vector<Stretch> &gone, const std::vector<Stretch> &added)
{
    std::vector<Pair> pairs;
    for (size_t a = 0; a < gone.size(); a++) {
        for (size_t b = 0; b < added.size(); b++) {
            if (may_be_one(gone[a], added[b])) {
                pairs.push_back({a, b, apart_um2(gone[a], added[b])});
            }
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair &a, const Pair &b) { return a.apart_um2 < b.apart_um2; });
    return pairs;
}

} // namespace

std::vector<ale::ChangedWall> changes_between(const ale_map_t &before, const ale_map_t &now)
{
    const std::vector<ale_wall_t> earlier = walls_of_map(before);
    const std::vector<ale_wall_t> later = walls_of_map(now);
    const std::vector<Stretch> gone = only_in(earlier, later);
    const std::vector<Stretch> added = only_in(later, earlier);
    std::vector<bool> is_paired(gone.size());
    std::vector<bool> is_moved(added.size());
    for (const Pair &pair : pairs_of(gone, added)) {
        if (!is_paired[pair.gone] && !is_moved[pair.added]) {
            is_paired[pair.gone] = is_moved[pair.added] = true;
        }
    }
    std::vector<ale::ChangedWall> changes;
    for (size_t k = 0; k < added.size(); k++) {
        changes.push_back(
            {is_moved[k] ? ale::WallChange::moved : ale::WallChange::added, added[k].start, added[k].end});
    }
    for (size_t k = 0; k < gone.size(); k++) {
        if (!is_paired[k]) {
            changes.push_back({ale::WallChange::gone, gone[k].start, gone[k].end});
        }
    }
    return changes;
}

int64_t walls_um(const ale_map_t &map)
{
    std::vector<ale::ChangedWall> all;
    for (uint32_t k = 0; k < map.line_count; k++) {
        all.push_back({ale::WallChange::added, map.line[k].start, map.line[k].end});
    }
    return ale::changed_um(all, ale::WallChange::added);
}

} // namespace merge
