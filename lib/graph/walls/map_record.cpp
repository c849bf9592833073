#include "graph/walls/map_record.h"

#include <algorithm>

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

// A look is taken when the robot has gone on so far, or turned, or after a while at rest.
constexpr int32_t look_step_um = 400000;
constexpr int32_t look_turn_bam = 400 * ALE_BAM_PER_MRAD;
constexpr int64_t look_wait_us = 5000000;

} // namespace

bool MapRecord::is_worth_a_look(const ale_scan_observation_t &sighting) const
{
    return sights_.empty() || !ale_are_near(looked_from_, sighting.seen.robot, look_step_um, look_turn_bam) ||
           ale_abs64(sighting.stamp_us - looked_us_) > look_wait_us;
}

void MapRecord::know(uint32_t epoch, const ale_map_t &map)
{
    *this = MapRecord();
    epoch_ = epoch;
    known_lines_.assign(map.line, map.line + map.line_count);
    known_corners_.assign(map.corner, map.corner + map.corner_count);
}

void MapRecord::take(const ale_scan_observation_t &sighting)
{
    if (sighting.epoch != epoch_) {
        *this = MapRecord();
        epoch_ = sighting.epoch;
    }
    const ale_seen_copy_t &seen = sighting.seen;
    Sight sight{sighting.scan,
                sighting.keyframe,
                sighting.smooth,
                seen.robot,
                {sighting.line, sighting.line + sighting.line_count},
                {sighting.corner, sighting.corner + sighting.corner_count},
                nullptr};
    if (is_worth_a_look(sighting)) {
        sight.look = std::make_unique<ale_seen_copy_t>(seen);
        looked_from_ = seen.robot;
        looked_us_ = sighting.stamp_us;
    }
    sights_.push_back(std::move(sight));
    sensor_ = ale_pose_between(seen.robot, seen.sensor);
}

void MapRecord::forget(const std::function<bool(const Sight &)> &is_spared)
{
    sights_.erase(std::remove_if(sights_.begin(), sights_.end(), is_spared), sights_.end());
}

} // namespace ale
