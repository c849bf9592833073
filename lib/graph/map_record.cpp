#include "graph/map_record.h"

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

bool MapRecord::is_worth_a_look(const ale_estimate_t &estimate) const
{
    return looks_.empty() ||
           !ale_are_near(looks_.back().seen.robot, estimate.map, look_step_um, look_turn_bam) ||
           ale_abs64(estimate.stamp_us - looks_.back().stamp_us) > look_wait_us;
}

void MapRecord::take(const ale_pipeline_t *pipeline, const ale_estimate_t &estimate)
{
    if (estimate.epoch != epoch_) {
        *this = MapRecord();
        epoch_ = estimate.epoch;
    }
    ale_seen_t seen;
    if (estimate.predicted || estimate.state == ALE_STATE_LOST || !ale_pipeline_seen(pipeline, &seen)) {
        return;
    }
    sensor_ = ale_pose_between(seen.robot, seen.sensor);
    if (is_worth_a_look(estimate)) {
        looks_.push_back({estimate.scan, estimate.stamp_us, {}});
        ale_seen_copy(&looks_.back().seen, &seen);
    }
    const auto look = static_cast<uint32_t>(looks_.size() - 1);
    for (uint32_t i = 0; i < seen.view_count && seen.view[i].kind == ALE_VIEW_WALL; i++) {
        lines_.push_back({estimate.scan, look, seen.view[i]});
    }
    const ale_features_t *features = ale_pipeline_features(pipeline);
    for (int i = 0; i < features->corner_count; i++) {
        corners_.push_back({estimate.scan, features->corner[i]});
    }
}

} // namespace ale
