#include "proofs/wcet/parts.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofs/wcet/scans.hpp"

extern "C" {
#include "match/observability.h"
#include "motion/deskew.h"
#include "track/map_update.h"
#include "track/pipeline_state.h"
}

namespace bench
{

namespace
{

/* What the fits of a scan of full size may look at together. */
constexpr int32_t most_looks = ALE_SCAN_WORK - ALE_BEAM_WORK * ALE_MAX_BEAMS;

constexpr ale_gate_t second_gate = {250000, 200000, 6, 100000};

ale_scene_t scene_of(const Crowd &crowd)
{
    return {crowd.map.get(), crowd.views.data(), static_cast<uint32_t>(crowd.views.size()), nullptr};
}

/* The last of them, of all views, is what it gives. */
std::unique_ptr<ale_fit_t> fits(Parts &parts, const ale_motion_t &predicted, Crowd &crowd)
{
    auto fit = std::make_unique<ale_fit_t>();
    auto other = std::make_unique<ale_fit_t>();
    parts.measure("near walls listed", 2, [&] {
        crowd.map->near_radius_um = 0;
        ale_local_map_approach(crowd.map.get(), {0, 0}, 30000000);
    });
    for (uint32_t views = 4; views <= crowd.views.size(); views += 4) { /* the fewer, the more steps */
        const ale_scene_t some = {crowd.map.get(), crowd.views.data(), views, nullptr};
        parts.measure("two fits", 1, [&] {
            ale_register_pose(&predicted, &some, &first_gate, fit.get());
            ale_register_associate(&some, fit.get());
            const ale_second_fit_t second = {&predicted, true, predicted.pose, &second_gate, most_looks, 0};
            ale_register_again(&some, &second, other.get(), fit.get());
            ale_register_weigh(&some, fit.get());
        });
    }
    return fit;
}

void vote(Parts &parts, const Crowd &crowd)
{
    auto memory = std::make_unique<ale_scan_match_t>();
    const ale_observations_t all = {crowd.views.data(), static_cast<uint32_t>(crowd.views.size())};
    ale_pose_t way = {0, 0, 0};
    parts.measure("vote of the last scan", 1,
                  [&] { ale_match_scans(memory.get(), all, all, 1000000, 450000, &way); });
}

/* All views begin something new in the map, then all are found in it; then the map says how far it may be
 * off.
 */
void taking_in(Parts &parts, const ale_motion_t &predicted, Crowd &crowd, ale_fit_t *fit)
{
    const ale_scene_t scene = scene_of(crowd);
    const ale_map_uncertainty_t here = {int64_t{1} << 41, int64_t{1} << 40, int64_t{1} << 41,
                                        int64_t{1} << 38, int64_t{1} << 38, int64_t{1} << 36};
    const ale_scale_error_t by_wheels = {100000, 100000};
    ale_map_update_context_t taking = {1, &here, &by_wheels, 1, true};
    std::fill(std::begin(fit->association), std::end(fit->association),
              ale_association_t{ALE_NO_WALL, ALE_NO_LANDMARK, {}});
    const auto take_in = [&] {
        ale_map_update(crowd.map.get(), scene.observation, scene.observation_count, fit, &taking);
    };
    parts.measure("walls and marks of the map", 1, take_in);
    ale_register_scan(&predicted, &scene, &first_gate, fit);
    taking.scan = 2;
    parts.measure("walls and marks of the map", 1, take_in);
    std::for_each(crowd.map->wall, crowd.map->wall + crowd.map->count,
                  [&](ale_wall_t &wall) { wall.map_uncertainty = here; });
    parts.measure("drift, and what holds the robot", 1, [&] {
        ale_map_uncertainty_here(crowd.map.get(), scene.observation, scene.observation_count, fit, &here);
        const ale_observability_t hold =
            ale_observability_of(crowd.map.get(), scene.observation, scene.observation_count, fit);
        ale_scale_error_t drift = by_wheels;
        ale_scale_error_update(&drift, &hold, &predicted);
        ale_motion_t found = predicted;
        ale_motion_keep_along(&found, &predicted, hold.along_bam);
    });
}

void matching(Parts &parts, Random &random, Crowd &crowd)
{
    const ale_motion_t predicted = any_motion(random);
    const std::unique_ptr<ale_fit_t> fit = fits(parts, predicted, crowd);
    vote(parts, crowd);
    taking_in(parts, predicted, crowd, fit.get());
}

/* The last scan is looked through for what has come: all views but one, which is in the map. late: something
 * came before. */
void notice(Parts &parts, const std::string &name, const ale_scan_t &before, const uint32_t *bearing_bam,
            std::vector<ale_observation_t> views, bool late)
{
    std::vector<ale_association_t> match(views.size(), {ALE_NO_WALL, ALE_NO_LANDMARK, {}});
    match.back().wall = 0;
    ale_scan_t scan = before;
    const int beams = scan.beams / static_cast<int>(views.size());
    for (size_t k = 0; k < views.size(); k++) {
        views[k].first_beam = static_cast<uint16_t>(static_cast<int>(k) * beams);
        views[k].last_beam = static_cast<uint16_t>(views[k].first_beam + beams - 1);
        for (uint16_t beam = views[k].first_beam; beam <= views[k].last_beam; beam++) {
            ale_scan_set_range(&scan, beam, k % 2 == 0 ? 1000000 : 2000000);
        }
    }
    scan.stamp_us = before.stamp_us + 100000;
    auto carried = std::make_unique<ale_carried_t>();
    carried->any = late;
    carried->beams = scan.beams;
    carried->came_us = before.stamp_us;
    const auto count = static_cast<uint32_t>(views.size());
    const ale_seen_t then = {{&before, bearing_bam, {0, 0, 0}}, {0, 0, 0}, views.data(), count};
    const ale_seen_t now = {{&scan, bearing_bam, {0, 0, 0}}, {0, 0, 0}, views.data(), count};
    parts.measure(name, 1,
                  [&] { ale_carried_notice(carried.get(), &then, &now, &scan, views.data(), match.data()); });
}

void witnesses(Parts &parts, Random &random, Crowd &crowd)
{
    auto pipeline = std::make_unique<ale_pipeline>();
    std::vector<uint32_t> bearing(ALE_MAX_BEAMS);
    ale_scan_t scan = far_scan(random); /* nothing to confirm, every beam is asked */
    const int32_t velocity[ALE_AXES] = {40000, 20000, 60000};
    ale_deskew(&scan, velocity, bearing.data());
    const ale_seen_t seen = {{&scan, bearing.data(), {0, 0, 0}},
                             {0, 0, 0},
                             crowd.views.data(),
                             static_cast<uint32_t>(crowd.views.size())};
    parts.measure("last scan kept", 1, [&] { ale_witness_keep(&pipeline->witness, &seen); });
    /* where the last scan and the map put the robot; the given pose and the best other one */
    parts.measure("last scan heard of four poses", 4, [&] {
        ale_witness_hear(&pipeline->witness, &seen, {60000, 0, false}); /* as ale_step_testimony */
    });
    const std::string heard = "last scan heard, or what has come"; /* the one or the other */
    parts.measure(heard, 1, [&] { ale_witness_hear(&pipeline->witness, &seen, {200000, 100000, false}); });
    notice(parts, heard, scan, bearing.data(), crowd.views, false);
    notice(parts, heard, scan, bearing.data(), crowd.views, true);
    ale_carried_t &carried = pipeline->carried;
    carried.any = true;
    carried.beams = scan.beams;
    std::copy(std::begin(scan.range_um), std::end(scan.range_um), std::begin(carried.came_um));
    ale_scan_t covered = scan;
    parts.measure("beams that go along", 1, [&] {
        ale_carried_mask(&carried, &covered);
        ale_carried_show(&carried, &covered);
    });
    for (int k = 0; k < 2 * ALE_ELDERS; k++) {
        scan.stamp_us += 10000000;
        ale_elders_keep(&pipeline->elders, &seen);
    }
    for (ale_elder_t &elder : pipeline->elders.elder) {
        elder = pipeline->elders.elder[0];
        std::fill(std::begin(elder.seen.scan.flag), std::end(elder.seen.scan.flag),
                  ALE_BEAM_NO_RETURN); /* none denies */
    }
    scan.stamp_us += 10000000;
    const std::string copied = "an elder kept, or a scan of the way"; /* the one or the other */
    parts.measure(copied, 1, [&] { ale_elders_keep(&pipeline->elders, &seen); });
    way_back(pipeline->way_back, seen);
    ale_seen_t gone_on = seen;
    gone_on.robot.x_um = pipeline->way_back.apart_um;
    parts.measure(copied, 1, [&] { ale_way_back_keep(&pipeline->way_back, &gone_on); });
    std::vector<ale_association_t> match(ALE_MAX_OBSERVATIONS, {ALE_NO_WALL, ALE_NO_LANDMARK, {}});
    parts.measure("elders asked", 1, [&] {
        ale_elders_drop_newcomers(&pipeline->elders, &pipeline->map, &seen, false, crowd.views.data(),
                                  match.data());
    });
    ale_map_decay_t fade = {0};
    ale_local_map_approach(crowd.map.get(), {0, 0}, 30000000);
    parts.measure("fading", 1, [&] {
        const ale_posed_scan_t from = {&scan, bearing.data(), {0, 0, 0}};
        ale_map_decay(&fade, crowd.map.get(), &from, 1000000, true);
    });
}

} // namespace

void way_back(ale_way_back_t &kept, const ale_seen_t &seen)
{
    ale_way_back_clear(&kept);
    for (ale_seen_copy_t &copy : kept.seen) {
        ale_seen_copy(&copy, &seen);
        kept.count++;
    }
}

void count_tracked(Parts &parts, Random &random, Crowd &crowd)
{
    matching(parts, random, crowd);
    witnesses(parts, random, crowd);
}

void count_corners(Parts &parts, Random &random)
{
    auto map = std::make_unique<ale_map_corners_t>();
    auto features = std::make_unique<ale_features_t>();
    ale_map_corners_clear(map.get());
    for (uint32_t scan = 0; scan < 2000; scan++) {
        features->corner_count = ALE_CORNERS_PER_SCAN;
        for (uint32_t k = 0; k < ALE_CORNERS_PER_SCAN; k++) {
            features->corner[k] = {};
            features->corner[k].p = {micrometres(random.uniform(-4, 4)), micrometres(random.uniform(-4, 4))};
            features->corner[k].bisector_bam = any_direction(random);
        }
        if (scan % 100 == 99) {
            parts.measure("corners of the map", 1, [&] {
                ale_map_corners_update(map.get(), features.get(), {0, 0, 12345}, scan, true);
            });
        } else {
            ale_map_corners_update(map.get(), features.get(), {0, 0, 12345}, scan, true);
        }
    }
}

} // namespace bench
