#include "common/offline/loops.h"

#include <algorithm>
#include <ctime>
#include <new>
#include <set>

#include "graph/optimise/scan_alignment.h"
#include "graph/optimise/scan_node.h"

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
#include "track/correction.h"
#include "track/keyframe.h"
}

namespace ale
{

namespace
{

int64_t thread_time_ns()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

/* From a to b, `part` of `whole` of the way. */
ale_pose_t blend(ale_pose_t a, ale_pose_t b, uint32_t part, uint32_t whole)
{
    const auto between = [part, whole](int64_t from, int64_t to) {
        return static_cast<int32_t>(from + ale_round_div((to - from) * part, whole));
    };
    const int64_t turn_bam = ale_bam_diff(b.theta_bam, a.theta_bam);
    return {between(a.x_um, b.x_um), between(a.y_um, b.y_um),
            a.theta_bam + static_cast<uint32_t>(ale_round_div(turn_bam * part, whole))};
}

/* Where a keyframe puts a scan that was tracked together with it. */
ale_pose_t placed(const ale_mapper_pose_t &keyframe, const ale_pose_t &smooth)
{
    return ale_pose_compose(ale_pose_shift(keyframe.smooth, keyframe.pose), smooth);
}

} // namespace

Loops::Loops()
    : mapper_(ale_mapper_create(ALE_MAPPER_KEYFRAMES)), keyframe_(std::make_unique<ale_keyframe_t>())
{
    if (!mapper_) {
        throw std::bad_alloc();
    }
}

void Loops::change_tiles(const ale_tile_change_t &change)
{
    if (ale_mapper_change_tiles(mapper_.get(), &change) < 0) {
        throw std::bad_alloc();
    }
}

void Loops::before_scan(ale_pipeline_t *pipeline, const Taken &taken)
{
    while (!due_.empty() && ale_pipeline_correct(pipeline, due_.front().get())) {
        if (taken) {
            taken(*due_.front());
        }
        due_.pop_front();
    }
}

void Loops::after_scan(ale_pipeline_t *pipeline, const ale_estimate_t &estimate)
{
    tracked_.push_back({estimate.smooth, estimate.map});
    ale_seen_t seen;
    const bool sees = ale_pipeline_seen(pipeline, &seen);
    const ale_features_t *features = ale_pipeline_features(pipeline);
    seen_.push_back(sees ? surface_of(seen, *features) : std::vector<SurfacePoint>());
    is_keyframe_ = ale_pipeline_keyframe(pipeline, keyframe_.get());
    if (!is_keyframe_) {
        if (sees) {
            const ale_pose_t sensor = ale_pose_between(seen.robot, seen.posed.sensor);
            ale_mapper_add_walls(mapper_.get(), &estimate.smooth, &sensor, features);
        }
        return;
    }
    if (keyframe_->broken) {
        breaks_.push_back(keyframe_->tied_from);
    }
    if (known_) {
        ale_mapper_set_prior_map(mapper_.get(), keyframe_->epoch, known_.get());
        known_.reset();
    }
    const int64_t start_ns = thread_time_ns();
    ale_mapper_add(mapper_.get(), keyframe_.get());
    take_correction();
    graph_version_++;
    longest_ns_ = std::max(longest_ns_, thread_time_ns() - start_ns);
}

void Loops::take_correction()
{
    auto correction = std::make_unique<ale_correction_t>();
    if (ale_mapper_correction(mapper_.get(), correction.get())) {
        due_.push_back(std::move(correction));
    }
}

void Loops::refine()
{
    for (bool more = true; more;) {
        const int64_t start_ns = thread_time_ns();
        more = ale_mapper_refine(mapper_.get());
        longest_ns_ = std::max(longest_ns_, thread_time_ns() - start_ns);
    }
    take_correction();
}

void Loops::finish(ale_pipeline_t *pipeline)
{
    refine();
    graph_version_ += graph_version_ > 0 ? 1 : 0;
    for (const auto &correction : due_) {
        correction->due = 0;
    }
    before_scan(pipeline);
    const uint32_t count = statistics().keyframes;
    for (uint32_t k = 0; k < count; k++) {
        keyframes_.push_back(ale_mapper_pose(mapper_.get(), k));
    }
    align();
}

/* Every scan, and not the keyframes alone, laid on what all of its map have seen; from the first keyframe on.
 */
void Loops::align()
{
    const auto count = static_cast<uint32_t>(tracked_.size());
    for (uint32_t scan = 0; scan < count; scan++) {
        corrected_.push_back(bent(scan));
    }
    if (keyframes_.empty()) {
        return;
    }
    std::set<uint32_t> maps;
    for (const ale_mapper_pose_t &keyframe : keyframes_) {
        maps.insert(keyframe.map_id);
    }
    for (const uint32_t map_id : maps) {
        align_map(map_id);
    }
}

/* Maps that never met lie over each other anyhow: each for itself. */
void Loops::align_map(uint32_t map_id)
{
    std::vector<uint32_t> numbers;
    std::vector<AlignedScan> scans;
    for (uint32_t scan = keyframes_.front().scan; scan < tracked_.size(); scan++) {
        if (map_of(scan) == map_id) {
            const bool follows = !numbers.empty() && numbers.back() == scan - 1;
            scans.push_back(
                {from_core(corrected_[scan]), follows && tied(scan - 1, scan), std::move(seen_[scan])});
            numbers.push_back(scan);
        }
    }
    ScanAlignment alignment(std::move(scans));
    while (alignment.step()) {
    }
    for (size_t k = 0; k < numbers.size(); k++) {
        corrected_[numbers[k]] = to_core(alignment.poses()[k]);
    }
}

/* One is taken where a map begins. */
uint32_t Loops::map_of(uint32_t scan) const
{
    const auto after = std::upper_bound(
        keyframes_.begin(), keyframes_.end(), scan,
        [](uint32_t number, const ale_mapper_pose_t &keyframe) { return number < keyframe.scan; });
    const auto last = after == keyframes_.begin() ? after : after - 1;
    return last == keyframes_.end() ? uint32_t{ALE_FIRST_MAP} : last->map_id;
}

/* Whether the way as tracked leads from one scan to the other. */
bool Loops::tied(uint32_t scan, uint32_t later) const
{
    const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), scan);
    return next == breaks_.end() || *next > later;
}

/* The way as tracked, bent to meet the keyframes before and after it. The mapper holds not every keyframe
 * that it was given: between two of them there may be any distance, and a break. */
ale_pose_t Loops::bent(uint32_t scan) const
{
    const Tracked &tracked = tracked_[scan];
    const auto after = std::upper_bound(
        keyframes_.begin(), keyframes_.end(), scan,
        [](uint32_t number, const ale_mapper_pose_t &keyframe) { return number < keyframe.scan; });
    const bool by_later = after != keyframes_.end() && tied(scan, after->scan);
    const bool by_earlier = after != keyframes_.begin() && tied((after - 1)->scan, scan);
    if (by_earlier && by_later) {
        const ale_mapper_pose_t &before = *(after - 1);
        return blend(placed(before, tracked.smooth), placed(*after, tracked.smooth), scan - before.scan,
                     after->scan - before.scan);
    }
    if (by_earlier) {
        return placed(*(after - 1), tracked.smooth);
    }
    return by_later ? placed(*after, tracked.smooth) : tracked.map;
}

} // namespace ale
