/* What the scans of a run saw, laid out in the map: points to draw, and what is free and occupied.
 *
 *   ScanCloud cloud;
 *   cloud.add(scan, pose, sensor);       every scan, with its pose in the map
 *
 * Points are kept one a cell of 20 mm; free and occupied are counted in cells of 50 mm, or another side: a
 * cell is free when beams passed it, occupied when they ended in it. Memory of cells grows with the area
 * seen, not with the time; that of points slowly with the time, too, as noise finds cells about a wall that
 * are free yet: who runs for days and draws no points leaves them out. */
#ifndef ALE_COMMON_EXPORT_SCAN_CLOUD_H
#define ALE_COMMON_EXPORT_SCAN_CLOUD_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "common/export/extent.h"
#include "common/offline/scan_pose.h"

extern "C" {
#include "base/pose.h"
#include "base/scan.h"
#include "observe/seen.h"
}

namespace ale
{

class ScanCloud
{
  public:
    static constexpr int32_t usual_cell_um = 50000;
    enum class Cell { unknown, free, occupied };

    enum class Points { kept, left_out };

    /* cell_um: 1000 to 1000000. */
    explicit ScanCloud(int32_t cell_um = usual_cell_um, Points points = Points::kept)
        : cell_um_(cell_um), keeps_points_(points == Points::kept)
    {
    }

    void add(const ale_scan_t &scan, const ScanPose &pose, const ale_pose_t &sensor);
    /* A scan that was straightened, with the pose of its sensor. */
    void add(const ale_seen_copy_t &seen, const ale_pose_t &sensor);
    const std::vector<ale_point_t> &points() const
    {
        return points_;
    }
    bool empty() const
    {
        return extent_.left_um > extent_.right_um;
    }
    /* Of all ends of beams; no_extent when empty. */
    const Extent &extent() const
    {
        return extent_;
    }
    /* Squares of 64 x 64 cells in which something was seen. */
    size_t tiles() const
    {
        return tiles_.size();
    }
    int32_t cell_um() const
    {
        return cell_um_;
    }
    /* Cell (column, row) covers x from column * cell_um() on, y from row * cell_um() on. */
    Cell cell(int32_t column, int32_t row) const;

  private:
    static constexpr int32_t tile_side = 64;
    struct Count {
        uint16_t passed = 0;
        uint16_t ended = 0;
    };
    using Tile = std::array<Count, static_cast<size_t>(tile_side) * tile_side>;

    void add_beam(const ale_pose_t &laser, int32_t range_um, uint32_t bearing_bam);
    void add_point(const ale_point_t &p);
    void add_ray(const ale_point_t &from, const ale_point_t &to);
    Count &count(int32_t column, int32_t row);

    int32_t cell_um_;
    bool keeps_points_;
    Extent extent_ = no_extent;
    std::vector<ale_point_t> points_;
    std::unordered_set<uint64_t> point_cells_;
    std::unordered_map<uint64_t, Tile> tiles_;
};

} // namespace ale

#endif
