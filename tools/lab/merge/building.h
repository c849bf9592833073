/* What drives show together: the walls of one frame, each once, and as the latest drive has found them. */
#ifndef ALE_LAB_MERGE_BUILDING_H
#define ALE_LAB_MERGE_BUILDING_H

#include <vector>

#include "common/export/scan_cloud.h"
#include "graph/walls/wall_corners.h"
#include "lab/merge/drive.h"

extern "C" {
#include "map/line_map.h"
}

namespace merge
{

/* The frame that most scans are in; of equals that of the earliest drive. */
uint32_t largest_frame(const std::vector<Drive> &drives);

class Building
{
  public:
    /* Of what is in this frame; takes the observations out of the drives, which are by date. `earlier`: what
     * drives before them have shown, or nullptr. */
    Building(std::vector<Drive> *drives, uint32_t frame, const ale_map_t *earlier = nullptr);

    /* Fills *out with ids from 0. See rebuild_map. */
    void draw(ale_map_t *out) const;

    /* The whole of it, where that is more than a map holds. See rebuild_walls. */
    ale::WallMap draw_all() const;

    /* The same of the first so many drives alone, and what was before them. */
    void draw_first(size_t drives, ale_map_t *out) const;

    /* What the scans saw that are kept with all their beams. */
    ale::ScanCloud cloud() const;

  private:
    std::optional<ale_pose_t> pose_of(const ale::RecordedScan &scan) const;

    ale::ObservationRecord record_;
    std::vector<std::optional<ale_pose_t>> poses_; /* by scan of the record; none: in another frame */
    std::vector<size_t> first_scan_;               /* by drive */
};

} // namespace merge

#endif
