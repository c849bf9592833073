#include "graph/walls/wall_spans.h"

#include <algorithm>
#include <cstddef>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "map/local_map.h"
#include "map/visibility.h"
}

namespace ale
{

namespace
{

constexpr int64_t cell_um = 50000;
constexpr size_t gap_cells = 3; // a gap this long is closed unless beams pass through it

// Walls this near to each other, and at most so turned, cannot both be seen.
constexpr int64_t beside_um = 120000;
constexpr int64_t beside_bam = int64_t{45} * ALE_BAM_PER_DEGREE;
constexpr int64_t parallel_um = 300000;
constexpr int64_t parallel_bam = int64_t{9} * ALE_BAM_PER_DEGREE;

// What scans have shown of a cell.
struct Shown {
    uint32_t scans = 0;  // whose lines cover it
    uint32_t hits = 0;   // whose beams end there
    uint32_t passes = 0; // whose beams go through, from either side
};

struct Cell {
    Shown shown;               // since the drive that found it changed
    Shown now;                 // by the drive that is being counted
    uint32_t prior_scans = 0;  // of the prior map, whose lines cover it
    uint32_t drive = 0;        // the latest whose lines cover it
    bool is_displaced = false; // by a wall beside it
};

bool is_wall(const Shown &shown)
{
    return shown.scans > 0 && shown.scans + shown.hits >= ALE_MAP_CONFIRMED && shown.passes <= shown.hits;
}

bool is_free(const Shown &shown)
{
    return shown.passes >= ALE_MAP_CONFIRMED && shown.passes > shown.hits;
}

struct Range {
    int64_t from_um;
    int64_t to_um;
};

// The same line, facing the other way; its tangent is turned, too.
ale_wall_t back_of(const ale_wall_t &wall)
{
    ale_wall_t back = wall;
    ale_wall_set_normal(&back, wall.normal_bam + ALE_BAM_HALF_TURN);
    back.start_um = -wall.end_um;
    back.end_um = -wall.start_um;
    return back;
}

Range along(const ale_wall_t &wall, const ale_observation_t &line)
{
    const ale_wall_error_t e = ale_wall_error(&wall, &line);
    return {e.t_um + line.start_um, e.t_um + line.end_um};
}

class Cells
{
  public:
    explicit Cells(const ale_wall_t &wall)
        : wall_(wall), back_(back_of(wall)),
          cells_(static_cast<size_t>((int64_t{wall.end_um} - wall.start_um) / cell_um + 1))
    {
    }

    // Counts a line in the cells whose middle it covers.
    void count_line(const PlacedLine &line)
    {
        const Range r = along(wall_, line.line);
        for (size_t k = 0; k < cells_.size(); k++) {
            if (middle_um(k) >= r.from_um && middle_um(k) <= r.to_um) {
                (line.scans > 1 ? cells_[k].prior_scans : cells_[k].now.scans) += line.scans;
            }
        }
    }

    // Counts where the beams of a scan end, and where they go through. What a scan from behind hits is
    // another surface, but its beams cannot come through what stands either.
    void count_beams(const PlacedScan &scan)
    {
        ale_posed_scan_t posed = ale_seen_copy_posed(scan.beams);
        posed.sensor = scan.sensor;
        const bool is_before = ale_wall_offset(&wall_, {scan.sensor.x_um, scan.sensor.y_um}) > 0;
        for (size_t k = 0; k < cells_.size(); k++) {
            const ale_visibility_t visibility = ale_wall_point_visibility(
                is_before ? &wall_ : &back_, is_before ? middle_um(k) : -middle_um(k), &posed);
            cells_[k].now.hits += is_before && visibility == ALE_VISIBILITY_SUPPORTED;
            cells_[k].now.passes += visibility == ALE_VISIBILITY_VIOLATED;
        }
    }

    // All of this drive is counted: it adds to what earlier ones have shown, or, where it shows the contrary,
    // takes its place.
    void end_drive(uint32_t drive)
    {
        for (Cell &cell : cells_) {
            const Shown &now = cell.now;
            const bool has_changed =
                (is_free(now) && is_wall(cell.shown)) || (is_wall(now) && is_free(cell.shown));
            const Shown before = has_changed ? Shown{} : cell.shown;
            cell.shown = {before.scans + now.scans, before.hits + now.hits, before.passes + now.passes};
            cell.drive = now.scans >= ALE_MAP_CONFIRMED ? drive : cell.drive;
            cell.now = {};
        }
    }

    bool is_shown(size_t k) const
    {
        Shown shown = cells_[k].shown;
        shown.scans += cells_[k].prior_scans;
        return is_wall(shown);
    }
    bool stands(size_t k) const
    {
        return is_shown(k) && !cells_[k].is_displaced;
    }

    // Marks the cells that a wall beside them displaces: a later drive shows that one, or more scans of as
    // late a drive; `first` of equals stays.
    // Scans of the drive decide before those of a prior map: what they show may hide it.
    void displace_by(const Cells &other, bool first)
    {
        const int64_t turned = ale_abs64(ale_bam_diff(wall_.normal_bam, other.wall_.normal_bam));
        if (turned > beside_bam) {
            return;
        }
        const int64_t near_um = turned > parallel_bam ? beside_um : parallel_um;
        for (size_t k = 0; k < cells_.size(); k++) {
            const ale_point_t p = ale_wall_point(&wall_, middle_um(k));
            const int64_t beside = other.cell_beside(p);
            if (beside < 0 || ale_abs64(ale_wall_offset(&other.wall_, p)) > near_um) {
                continue;
            }
            const auto other_k = static_cast<size_t>(beside);
            const Cell nothing;
            const Cell &own = cells_[k];
            const Cell &its = other.is_shown(other_k) ? other.cells_[other_k] : nothing;
            const bool is_driven = std::max(own.shown.scans, its.shown.scans) >= ALE_MAP_CONFIRMED;
            const uint32_t own_scans = own.shown.scans + (is_driven ? 0 : own.prior_scans);
            const uint32_t its_scans = its.shown.scans + (is_driven ? 0 : its.prior_scans);
            const bool has_more = its_scans > own_scans || (its_scans == own_scans && !first);
            cells_[k].is_displaced |= its.drive == own.drive ? has_more : its.drive > own.drive;
        }
    }

    // Whether beams go through, so that a gap is not closed.
    bool is_open(size_t k) const
    {
        return cells_[k].shown.passes > cells_[k].shown.hits;
    }

    size_t size() const
    {
        return cells_.size();
    }
    int64_t middle_um(size_t k) const
    {
        return wall_.start_um + static_cast<int64_t>(k) * cell_um + cell_um / 2;
    }

  private:
    // The cell at the foot of a point, or -1: beyond the ends.
    int64_t cell_beside(ale_point_t p) const
    {
        const int64_t t_um = ale_wall_along(&wall_, p);
        const int64_t k = t_um < wall_.start_um ? -1 : (t_um - wall_.start_um) / cell_um;
        return k < static_cast<int64_t>(cells_.size()) ? k : -1;
    }

    ale_wall_t wall_;
    ale_wall_t back_;
    std::vector<Cell> cells_;
};

// Whether the sensor is within reach.
bool may_see(const PlacedScan &scan, const ale_wall_t &wall)
{
    const ale_point_t at = {scan.sensor.x_um, scan.sensor.y_um};
    const int64_t reach_um = scan.beams->scan.range_max_um;
    const int64_t t_um = ale_wall_along(&wall, at);
    return ale_abs64(ale_wall_offset(&wall, at)) < reach_um && t_um > wall.start_um - reach_um &&
           t_um < wall.end_um + reach_um;
}

// The next run of standing cells from k on, gaps closed: first, and one past the last.
bool next_run(const Cells &cells, size_t k, size_t *first, size_t *last)
{
    while (k < cells.size() && !cells.stands(k)) {
        k++;
    }
    *first = k;
    *last = k;
    size_t gap = 0;
    for (; k < cells.size() && gap <= gap_cells && !(gap > 0 && cells.is_open(k)); k++) {
        gap = cells.stands(k) ? 0 : gap + 1;
        *last = gap == 0 ? k + 1 : *last;
    }
    return *first < *last;
}

uint32_t scans_in(const WallGroup &group, const std::vector<PlacedLine> &lines, int64_t from_um,
                  int64_t to_um)
{
    uint32_t scans = 0;
    uint32_t last = UINT32_MAX;
    for (const uint32_t k : group.lines) {
        const Range r = along(group.wall, lines[k].line);
        if (r.from_um < to_um && r.to_um > from_um && (lines[k].scan != last || lines[k].scans > 1)) {
            scans += lines[k].scans;
            last = lines[k].scan;
        }
    }
    return scans;
}

Cells cells_of(const WallGroup &group, const std::vector<PlacedLine> &lines,
               const std::vector<PlacedScan> &scans)
{
    Cells cells(group.wall);
    auto line = group.lines.begin();
    auto scan = scans.begin();
    while (line != group.lines.end() || scan != scans.end()) {
        const uint32_t drive = std::min(line != group.lines.end() ? lines[*line].drive : UINT32_MAX,
                                        scan != scans.end() ? scan->drive : UINT32_MAX);
        for (; line != group.lines.end() && lines[*line].drive == drive; ++line) {
            cells.count_line(lines[*line]);
        }
        for (; scan != scans.end() && scan->drive == drive; ++scan) {
            if (may_see(*scan, group.wall)) {
                cells.count_beams(*scan);
            }
        }
        cells.end_drive(drive);
    }
    return cells;
}

void add_spans(const Cells &cells, const WallGroup &group, const std::vector<PlacedLine> &lines,
               std::vector<WallSpan> *spans)
{
    size_t first = 0;
    size_t last = 0;
    for (size_t k = 0; next_run(cells, k, &first, &last); k = last) {
        ale_wall_t wall = group.wall;
        wall.start_um = static_cast<int32_t>(cells.middle_um(first) - cell_um / 2);
        wall.end_um = static_cast<int32_t>(cells.middle_um(last - 1) + cell_um / 2);
        const uint32_t scans = scans_in(group, lines, wall.start_um, wall.end_um);
        if (wall.end_um - wall.start_um >= ALE_WALL_LENGTH_UM && scans >= ALE_MAP_CONFIRMED) {
            spans->push_back({wall, scans});
        }
    }
}

} // namespace

std::vector<WallSpan> spans_of(const std::vector<WallGroup> &groups, const std::vector<PlacedLine> &lines,
                               const std::vector<PlacedScan> &scans)
{
    std::vector<Cells> cells;
    cells.reserve(groups.size());
    for (const WallGroup &group : groups) {
        cells.push_back(cells_of(group, lines, scans));
    }
    for (size_t a = 0; a < groups.size(); a++) {
        for (size_t b = 0; b < groups.size(); b++) {
            if (a != b) {
                cells[a].displace_by(cells[b], a < b);
            }
        }
    }
    std::vector<WallSpan> spans;
    for (size_t k = 0; k < groups.size(); k++) {
        add_spans(cells[k], groups[k], lines, &spans);
    }
    return spans;
}

} // namespace ale
