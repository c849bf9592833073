#include "graph/walls/wall_groups.h"

#include <algorithm>
#include <numeric>

extern "C" {
#include "base/fixed.h"
#include "map/wall.h"
}

namespace ale
{

namespace
{

constexpr int64_t million = 1000000;
constexpr int64_t gate2 = 9; // squared sigmas

// Largest distance and angle of a line from its wall, whatever the variances.
constexpr int64_t line_offset_um = 80000;
constexpr int64_t line_angle_urad = 150000;
constexpr int64_t least_common_um = 0;

// The same for two groups.
constexpr int64_t beside_offset_um = 300000;
constexpr int64_t beside_angle_urad = 150000;

// Two lines of one scan this far apart are two surfaces.
constexpr int64_t apart_um = 40000;
constexpr int apart_least = 2; // scans

int64_t length_um(const ale_observation_t &line)
{
    return int64_t{line.end_um} - line.start_um;
}

// Offset at t of a wall, from the error at the centre of the observation.
int64_t offset_at(const ale_wall_error_t &e, int64_t t_um)
{
    return e.offset_um + ale_mul_div(t_um - e.t_um, e.angle_urad, million);
}

void observe(ale_wall_t *wall, const PlacedLine &line)
{
    const ale_wall_error_t e = ale_wall_error(wall, &line.line);
    ale_wall_observe(wall, &e, line.line.var_offset_um2 + line.pose_var_um2,
                     line.line.var_angle_urad2 + line.pose_var_urad2);
    ale_wall_extend(wall, e.t_um + line.line.start_um, e.t_um + line.line.end_um);
    wall->seen++;
}

ale_wall_t wall_from(const PlacedLine &line)
{
    ale_wall_t wall;
    ale_wall_from_observation(&wall, &line.line);
    wall.var_offset_um2 += line.pose_var_um2;
    wall.var_angle_urad2 += line.pose_var_urad2;
    wall.seen = 1;
    return wall;
}

// Squared distance of offset and angle in thousandths of a sigma squared, or -1: not this wall.
int64_t distance2(const ale_wall_t &wall, const PlacedLine &line)
{
    const ale_wall_error_t e = ale_wall_error(&wall, &line.line);
    if (e.overlap_um < least_common_um || ale_abs64(e.offset_um) > line_offset_um ||
        ale_abs64(e.angle_urad) > line_angle_urad) {
        return -1;
    }
    const int64_t var = ale_wall_offset_var(&wall, e.t_um) + line.line.var_offset_um2 + line.pose_var_um2;
    const int64_t var_angle = wall.var_angle_urad2 + line.line.var_angle_urad2 + line.pose_var_urad2;
    const int64_t offset2 = e.offset_um * e.offset_um;
    const int64_t angle2 = e.angle_urad * e.angle_urad;
    if (offset2 > gate2 * var || angle2 > gate2 * var_angle) {
        return -1;
    }
    return 1000 * offset2 / var + 1000 * angle2 / var_angle;
}

std::vector<WallGroup> assign_lines(const std::vector<PlacedLine> &lines)
{
    std::vector<uint32_t> order(lines.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return length_um(lines[a].line) > length_um(lines[b].line);
    });
    std::vector<WallGroup> groups;
    for (const uint32_t k : order) {
        WallGroup *best = nullptr;
        int64_t least = 0;
        for (WallGroup &group : groups) {
            const int64_t d2 = distance2(group.wall, lines[k]);
            if (d2 >= 0 && (!best || d2 < least)) {
                best = &group;
                least = d2;
            }
        }
        if (best) {
            observe(&best->wall, lines[k]);
            best->lines.push_back(k);
        } else if (length_um(lines[k].line) >= ALE_WALL_LENGTH_UM) {
            groups.push_back({wall_from(lines[k]), {k}});
        }
    }
    for (WallGroup &group : groups) {
        std::sort(group.lines.begin(), group.lines.end());
    }
    return groups;
}

// Whether two lines of one scan are two surfaces: neither continues the other. The pose of the scan has no
// effect on this.
bool are_two_surfaces(const ale_observation_t &a, const ale_observation_t &b)
{
    ale_wall_t wall;
    ale_wall_from_observation(&wall, &a);
    const ale_wall_error_t e = ale_wall_error(&wall, &b);
    const bool before = e.t_um + b.end_um < wall.start_um;
    const int64_t nearest_um =
        before ? e.t_um + b.end_um : ale_max64(e.t_um + b.start_um, wall.start_um); // end of b
    const int64_t offset_um = offset_at(e, nearest_um);
    const int64_t aside_um = nearest_um - e.t_um;
    const int64_t var = ale_wall_offset_var(&wall, nearest_um) + b.var_offset_um2 +
                        ale_mul_div(b.var_angle_urad2, aside_um * aside_um, million * million);
    return ale_abs64(offset_um) > apart_um && offset_um * offset_um > gate2 * var;
}

// Whether the scans that show both groups show two surfaces: in enough scans, and at least as many as not.
bool are_seen_apart(const std::vector<PlacedLine> &lines, const WallGroup &a, const WallGroup &b)
{
    int one = 0;
    int two = 0;
    auto next = b.lines.begin();
    for (const uint32_t k : a.lines) {
        while (next != b.lines.end() && lines[*next].scan < lines[k].scan) {
            ++next;
        }
        for (auto other = next; other != b.lines.end() && lines[*other].scan == lines[k].scan; ++other) {
            (are_two_surfaces(lines[k].line, lines[*other].line) ? two : one) +=
                std::min(apart_least, static_cast<int>(lines[k].scans));
        }
    }
    return two >= apart_least && two >= one;
}

bool is_prior(const std::vector<PlacedLine> &lines, const WallGroup &group)
{
    return std::any_of(group.lines.begin(), group.lines.end(),
                       [&](uint32_t k) { return lines[k].scans > 1; });
}

bool share_a_drive(const std::vector<PlacedLine> &lines, const WallGroup &a, const WallGroup &b)
{
    auto k = a.lines.begin();
    auto m = b.lines.begin();
    while (k != a.lines.end() && m != b.lines.end() && lines[*k].drive != lines[*m].drive) {
        (lines[*k].drive < lines[*m].drive ? k : m)++;
    }
    return k != a.lines.end() && m != b.lines.end();
}

// Poses are already matched to the walls of a prior map: what lies beside one is another surface. So is what
// two drives have seen each for itself: it was moved.
int64_t farthest_um(const std::vector<PlacedLine> &lines, const WallGroup &a, const WallGroup &b)
{
    const bool are_alike = is_prior(lines, a) == is_prior(lines, b) && share_a_drive(lines, a, b);
    return are_alike ? beside_offset_um : line_offset_um;
}

bool are_one(const std::vector<PlacedLine> &lines, const WallGroup &a, const WallGroup &b)
{
    const ale_observation_t other = as_observation(b.wall);
    const ale_wall_error_t e = ale_wall_error(&a.wall, &other);
    if (e.overlap_um < 0 || ale_abs64(e.angle_urad) > beside_angle_urad) {
        return false;
    }
    const int64_t middle_um = (ale_min64(a.wall.end_um, e.t_um + b.wall.end_um) +
                               ale_max64(a.wall.start_um, e.t_um + b.wall.start_um)) /
                              2;
    const int64_t offset_um = offset_at(e, middle_um);
    return ale_abs64(offset_um) < beside_offset_um && ale_abs64(offset_um) < farthest_um(lines, a, b) &&
           !are_seen_apart(lines, a, b);
}

void merge(const std::vector<PlacedLine> &lines, WallGroup *into, const WallGroup &other)
{
    for (const uint32_t k : other.lines) {
        observe(&into->wall, lines[k]);
    }
    std::vector<uint32_t> both;
    std::merge(into->lines.begin(), into->lines.end(), other.lines.begin(), other.lines.end(),
               std::back_inserter(both));
    into->lines = std::move(both);
}

} // namespace

ale_observation_t as_observation(const ale_wall_t &wall)
{
    ale_observation_t line{};
    line.centre = wall.anchor;
    line.normal_bam = wall.normal_bam;
    line.start_um = wall.start_um;
    line.end_um = wall.end_um;
    line.var_offset_um2 = wall.var_offset_um2;
    line.var_angle_urad2 = wall.var_angle_urad2;
    return line;
}

std::vector<WallGroup> group_lines(const std::vector<PlacedLine> &lines)
{
    std::vector<WallGroup> groups = assign_lines(lines);
    // Every merge removes a group, so this ends. A merged group may now reach an earlier one.
    for (bool merged = true; merged;) {
        merged = false;
        for (size_t a = 0; a < groups.size(); a++) {
            for (size_t b = a + 1; b < groups.size();) {
                if (are_one(lines, groups[a], groups[b])) {
                    merge(lines, &groups[a], groups[b]);
                    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(b));
                    merged = true;
                } else {
                    b++;
                }
            }
        }
    }
    return groups;
}

} // namespace ale
