// What the scans of a drive have shown, kept until it is over: from this the map is drawn anew.
//
//   MapRecord record;
//   record.take(pipeline, estimate);        (after every scan)
//
// Lines and corners of all scans, about 1 kB a scan, and of some scans all beams (11 kB), a look: they say
// where nothing stands.
#ifndef ALE_GRAPH_MAP_RECORD_H
#define ALE_GRAPH_MAP_RECORD_H

#include <cstdint>
#include <deque>
#include <vector>

extern "C" {
#include "extract/extract.h"
#include "track/pipeline.h"
#include "track/seen.h"
#include "track/view.h"
}

namespace ale
{

// A line or a corner as one scan showed it. look: index of the last look at or before the scan.
struct LineSight {
    uint32_t scan;
    uint32_t look;
    ale_view_t view; // robot's frame
};
struct CornerSight {
    uint32_t scan;
    ale_corner_t corner; // sensor's frame
};

struct Look {
    uint32_t scan;
    int64_t stamp_us;
    ale_seen_copy_t seen;
};

class MapRecord
{
  public:
    // The scan that the pipeline has just answered. Lost and predicted ones are left out; a map begun anew
    // forgets what was kept.
    void take(const ale_pipeline_t *pipeline, const ale_estimate_t &estimate);

    // Scans ascending.
    const std::vector<LineSight> &lines() const
    {
        return lines_;
    }
    const std::vector<CornerSight> &corners() const
    {
        return corners_;
    }
    const std::deque<Look> &looks() const
    {
        return looks_;
    }
    // Of the laser on the robot.
    const ale_pose_t &sensor() const
    {
        return sensor_;
    }

  private:
    bool is_worth_a_look(const ale_estimate_t &estimate) const;

    uint32_t epoch_ = 0;
    ale_pose_t sensor_{};
    std::vector<LineSight> lines_;
    std::vector<CornerSight> corners_;
    std::deque<Look> looks_;
};

} // namespace ale

#endif
