// What the scans of a drive have shown: from this the map is drawn anew.
//
//   MapRecord record;
//   record.take(sighting);        (of every scan that counts)
//
// Lines and corners of all of them, about 1 kB a scan, and of some all beams (11 kB), a look: they say where
// nothing stands.
#ifndef ALE_GRAPH_WALLS_MAP_RECORD_H
#define ALE_GRAPH_WALLS_MAP_RECORD_H

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "track/scan_observation.h"
}

namespace ale
{

struct Sight {
    uint32_t scan;
    uint32_t keyframe;                     // that it belongs to
    ale_pose_t smooth;                     // where it was taken
    ale_pose_t tracked;                    // the same, in the map as it was then
    std::vector<ale_observation_t> lines;  // robot's frame
    std::vector<ale_corner_t> corners;     // sensor's frame
    std::unique_ptr<ale_seen_copy_t> look; // of some
};

class MapRecord
{
  public:
    // The map of this epoch is not begun by the drive, but this one: what it holds counts as seen before the
    // first sight. Before the first sighting of the epoch.
    void know(uint32_t epoch, const ale_map_t &map);

    // Of a later scan than the last one. That of a map begun anew forgets what was kept.
    void take(const ale_scan_observation_t &sighting);

    // Forgets those for which this holds.
    void forget(const std::function<bool(const Sight &)> &is_spared);

    // Scans ascending.
    const std::vector<Sight> &sights() const
    {
        return sights_;
    }
    // Walls and corners that the drive began with.
    const std::vector<ale_map_line_t> &known_lines() const
    {
        return known_lines_;
    }
    const std::vector<ale_map_corner_t> &known_corners() const
    {
        return known_corners_;
    }
    // Of the laser on the robot.
    const ale_pose_t &sensor() const
    {
        return sensor_;
    }
    // Of the map; 0 before the first sighting.
    uint32_t epoch() const
    {
        return epoch_;
    }

  private:
    bool is_worth_a_look(const ale_scan_observation_t &sighting) const;

    uint32_t epoch_ = 0;
    ale_pose_t sensor_{};
    std::vector<ale_map_line_t> known_lines_;
    std::vector<ale_map_corner_t> known_corners_;
    std::vector<Sight> sights_;
    ale_pose_t looked_from_{};
    int64_t looked_us_ = 0;
};

} // namespace ale

#endif
