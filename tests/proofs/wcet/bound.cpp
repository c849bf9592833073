#include "proofs/wcet/bound.hpp"

#include <algorithm>
#include <memory>

#include "lab/bench/random.hpp"
#include "proofs/wcet/crowd.hpp"
#include "proofs/wcet/scans.hpp"

extern "C" {
#include "base/trig.h"
#include "extract/breakpoint.h"
#include "extract/corner.h"
#include "extract/curve.h"
#include "extract/line_fit.h"
#include "extract/merge.h"
#include "extract/moments.h"
#include "extract/outlier.h"
#include "extract/points.h"
#include "extract/run_list.h"
#include "extract/run_noise.h"
#include "extract/runs.h"
#include "extract/scan_noise.h"
#include "extract/seam.h"
#include "extract/segment.h"
#include "map/map_exchange.h"
#include "map/tile_change.h"
#include "match/observability.h"
#include "motion/deskew.h"
#include "observe/short_segment.h"
#include "track/map_update.h"
#include "track/maps.h"
#include "track/pipeline_state.h"
#include "track/step_associate.h"
#include "track/step_filter.h"
#include "track/step_predict.h"
#include "track/step_recover.h"
#include "track/step_search.h"
#include "track/step_track.h"
}

namespace bench
{

namespace
{

constexpr int seeds = 8;
constexpr int pool_scans = 60;
constexpr int32_t centimetre_um = 10000;

/* Everything that is measured more than once counts as the most it took. */
class Parts
{
  public:
    explicit Parts(InstructionCounter &counter) : counter_(counter)
    {
    }

    template <typename Call> void measure(const std::string &name, int times, Call call)
    {
        const uint64_t each = counter_.of(call);
        for (BoundPart &part : parts_) {
            if (part.name == name) {
                part.each = std::max(part.each, each);
                return;
            }
        }
        parts_.push_back({name, times, each});
    }

    std::vector<BoundPart> take()
    {
        return std::move(parts_);
    }

  private:
    InstructionCounter &counter_;
    std::vector<BoundPart> parts_;
};

/* A scan of full size of anything between walls and noise. */
ale_scan_t any_scan(Random &random)
{
    Costly costly;
    for (int k = 0; k < 12; k++) {
        costly = changed(costly, random);
    }
    return scan_of(costly, 0, random);
}

/* The same with bearings of their own, which every step that asks for them takes one by one. */
ale_scan_t with_own_bearings(const ale_scan_t &scan)
{
    ale_scan_t own = scan;
    own.own_bearings = true;
    for (int k = 0; k < scan.beams; k++) {
        own.bearing_bam[k] = ale_scan_bearing(&scan, k);
    }
    return own;
}

/* What a whole turn takes besides: its order, and what meets at the seam. */
void open_seam(Parts &parts, ale_prepared_scan_t *scan)
{
    scan->points.turn_beams = ALE_MAX_BEAMS;
    parts.measure("order of a whole turn", 1, [&] { ale_seam_open(scan); });
}

void close_seam(Parts &parts, ale_run_list_t *runs)
{
    runs->scan.points.turn_beams = ALE_MAX_BEAMS;
    runs->scan.segments.jump_at_seam = false;
    parts.measure("seam of a whole turn", 1, [&] { ale_seam_close(runs); });
}

/* The extractor's steps, in the order of ale_extract_scan, each as often as it is taken at most: a scan that
 * is costly to search is searched once; one with more than ALE_MANY_RUNS runs is spared breaks and curves,
 * which cost more than the fits of the runs beyond. */
void extraction(Parts &parts, ale_extractor_t *e, const ale_scan_t &scan, const uint32_t *bearing_bam,
                ale_features_t *out)
{
    ale_run_list_t *runs = &e->runs;
    ale_points_t *points = &runs->scan.points;
    ale_scan_noise_t *noise = &runs->scan.noise;
    ale_segments_t *segments = &runs->scan.segments;
    parts.measure("points", 1, [&] { ale_points_list(points, &scan, bearing_bam); });
    open_seam(parts, &runs->scan);
    ale_points_list(points, &scan, bearing_bam);
    const ale_scan_t own = with_own_bearings(scan);
    for (const ale_scan_t *one : {&own, &scan}) {
        parts.measure("noise of the beams", 1,
                      [&] { ale_scan_noise_measure(noise, &e->config.noise, points, one); });
    }
    parts.measure("suspects", 1, [&] { ale_segment_suspect(segments, points, noise); });
    parts.measure("spikes", 1, [&] { ale_outlier_remove_spikes(points, segments, noise); });
    parts.measure("segments", 1, [&] { ale_segment_cut(segments, points, noise); });
    parts.measure("stray points", 1, [&] { ale_outlier_remove_strays(points, segments); });
    parts.measure("segments again", 1, [&] { ale_segment_cut(segments, points, noise); });
    parts.measure("places of the points", 1, [&] { ale_points_place(points, &scan, bearing_bam); });
    parts.measure("moments", 1, [&] { ale_moments_build(&runs->scan); });
    parts.measure("search of the runs", 1, [&] { ale_runs_search(runs); });
    parts.measure("shared noise", 1, [&] { ale_run_noise_measure_shared(runs, scan.step_bam); });
    ale_run_list_forget_fits(runs);
    parts.measure("own noise again", 1, [&] { ale_run_noise_refine_own(runs); });
    if (runs->count > (ale_costly(runs) ? ALE_MANY_RUNS / 3 : ALE_MANY_RUNS)) {
        ale_run_list_drop_short(runs, ALE_COSTLY_RUN, ALE_MANY_RUNS);
        parts.measure("runs joined", 1, [&] { ale_merge_runs(runs); });
    } else {
        parts.measure("runs joined", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed", 1, [&] { ale_runs_place(runs, ALE_BREAK_WIDE_STEP); });
        parts.measure("curves", 1, [&] { ale_curve_find(runs, false); });
        parts.measure("runs split", 1, [&] { ale_runs_split(runs); });
        parts.measure("runs joined again", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed again", 1, [&] { ale_runs_place(runs, ALE_BREAK_FINE_STEP); });
        parts.measure("own noise, third time", 1, [&] { ale_run_noise_refine_own(runs); });
        parts.measure("runs split again", 1, [&] { ale_runs_split(runs); });
        parts.measure("runs joined, third time", 1, [&] { ale_merge_runs(runs); });
        parts.measure("breaks placed, third time", 1, [&] { ale_runs_place(runs, ALE_BREAK_WIDE_STEP); });
        runs->run[0].no_curve = false; // one that has changed, and all are asked
        parts.measure("curves again", 1, [&] { ale_curve_find(runs, true); });
    }
    close_seam(parts, runs);
    for (int32_t k = 0; k < runs->count; k++) {
        ale_line_t line;
        parts.measure("a line's fit", ALE_MANY_RUNS, [&] {
            ale_line_fit(&runs->scan, {runs->run[k].first, runs->run[k].last}, &line);
        });
    }
    ale_extract_scan(e, &scan, nullptr, out);
    parts.measure("corners", 1, [&] { ale_corner_find(points->step_nrad, points->turn_beams, out); });
}

void looking(Parts &parts)
{
    Random random(3);
    const ale_pipeline_config_t config = ale_pipeline_default_config();
    const ale_noise_t &noise = config.extract.noise;
    auto extractor = std::make_unique<ale_extractor_t>();
    auto features = std::make_unique<ale_features_t>();
    auto pieces = std::make_unique<ale_segment_workspace_t>();
    std::vector<ale_observation_t> views(ALE_MAX_OBSERVATIONS);
    ale_extractor_init(extractor.get(), &config.extract);
    const ale_scan_t first =
        any_scan(random); /* with it the beams' directions are listed; it meets an empty map */
    ale_extract_scan(extractor.get(), &first, nullptr, features.get());
    for (int k = 0; k < pool_scans; k++) {
        std::vector<uint32_t> bearing(ALE_MAX_BEAMS);
        ale_scan_t moved = any_scan(random);
        const int32_t velocity[ALE_AXES] = {40000, 20000, 60000};
        ale_scan_t own = with_own_bearings(moved);
        parts.measure("straightening", 1, [&] { ale_deskew(&moved, velocity, bearing.data()); });
        parts.measure("straightening", 1, [&] { ale_deskew(&own, velocity, bearing.data()); });
        extraction(parts, extractor.get(), any_scan(random), bearing.data(), features.get());
        const ale_scan_t scan = any_scan(random);
        ale_extract_scan(extractor.get(), &scan, bearing.data(), features.get());
        parts.measure("views of lines", 1, [&] {
            ale_observe_lines(features.get(), &scan, {0, 0, 0}, 3000, views.data());
        });
        features->line_count = 0;
        parts.measure("views of pieces", 1, [&] {
            const ale_posed_scan_t from = {&scan, bearing.data(), {0, 0, 0}};
            ale_observe_segments(features.get(), &from, &noise, pieces.get(), ALE_MAX_OBSERVATIONS,
                                 views.data());
        });
    }
}

/* What the fits of a scan of full size may look at together. */
constexpr int32_t most_looks = ALE_SCAN_WORK - ALE_BEAM_WORK * ALE_MAX_BEAMS;

constexpr ale_gate_t first_gate = {600000, 300000, 4, 100000};
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

/* Scans with the ranges of a robot that sees through every wall. */
ale_scan_t far_scan(Random &random)
{
    ale_scan_t scan = any_scan(random);
    for (uint16_t k = 0; k < scan.beams; k++) {
        ale_scan_set_range(&scan, k, 25000000);
    }
    return scan;
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

/* As many scans from along the way as are kept. */
void way_back(ale_way_back_t &kept, const ale_seen_t &seen)
{
    ale_way_back_clear(&kept);
    for (ale_seen_copy_t &copy : kept.seen) {
        ale_seen_copy(&copy, &seen);
        kept.count++;
    }
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
    parts.measure("last scan heard of two poses", 2, [&] {
        ale_witness_hear(&pipeline->witness, &seen, {200000, 100000, false});
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

/* A robot in the middle of a crowd, with a scan that looks through all walls and shows so many of the views.
 */
class Lost
{
  public:
    Lost(Random &random, const Crowd &crowd) : crowd_(crowd), scan_(far_scan(random))
    {
        const ale_pipeline_config_t config = ale_pipeline_default_config();
        ale_pipeline_init(pipeline_.get(), &config);
        ale_estimate_t estimate;
        ale_pipeline_scan(pipeline_.get(), &scan_, &estimate);
    }
    /* As it was, whatever a call has done with it. */
    ale_pipeline_t *operator()(uint32_t views)
    {
        ale_pipeline_t *p = pipeline_.get();
        p->map = *crowd_.map;
        p->observed.scan = scan_;
        std::copy(crowd_.views.begin(), crowd_.views.end(), std::begin(p->observed.observation));
        p->observed.count = views;
        ale_filter_begin(p);
        ale_atlas_init(&p->atlas);
        p->motion.pose = {0, 0, 0};
        return p;
    }
    /* Two seconds after a scan has last told where it is. */
    ale_prediction_t prediction(const ale_motion_t &predicted) const
    {
        ale_prediction_t prediction{};
        prediction.before = prediction.ways.believed = prediction.ways.rival = predicted;
        prediction.ways.believed.stamp_us = pipeline_->watched.stamp_us + unwatched_us;
        prediction.dt_us = unwatched_us;
        return prediction;
    }

  private:
    static constexpr int64_t unwatched_us = 2000000;
    const Crowd &crowd_;
    ale_scan_t scan_;
    std::unique_ptr<ale_pipeline> pipeline_ = std::make_unique<ale_pipeline>();
};

/* All headings and places of the region, and the fits of the best. */
void recovery(Parts &parts, Random &random, Lost &lost)
{
    for (uint32_t views = 4; views <= ALE_MAX_OBSERVATIONS; views += 8) {
        ale_pipeline_t *p = lost(views);
        const ale_prediction_t prediction = lost.prediction(any_motion(random));
        ale_ways_t ways = prediction.ways;
        auto fit = std::make_unique<ale_fit_t>();
        const ale_scene_t scene = {&p->map, p->observed.observation, views, nullptr};
        ale_register_scan(&ways.believed, &scene, &first_gate, fit.get());
        parts.measure("lost: where else it can be", 1,
                      [&] { ale_step_recover(p, &prediction, &ways, fit.get()); });
    }
}

/* In place of the oldest of as many maps as there may be, which holds half of all that there is. */
void beginning(Parts &parts, Lost &lost)
{
    ale_pipeline_t *p = lost(ALE_MAX_OBSERVATIONS);
    while (ale_atlas_maps(&p->atlas) < ALE_ATLAS_MAPS) {
        ale_atlas_begin(&p->atlas);
    }
    for (uint16_t i = 0; i < p->map.count; i += 2) {
        p->map.wall[i].map = 1;
    }
    parts.measure("lost: a map begins", 1, [&] {
        ale_maps_begin(p);
        ale_step_track_first(p);
    });
}

/* A tenth of the walls are in the robot's own map too, where they were seen just now. */
void own_map(ale_pipeline_t *p)
{
    ale_atlas_begin(&p->atlas);
    for (uint16_t i = 0; i < p->map.count; i += 10) {
        ale_wall_t wall = p->map.wall[i];
        wall.map = p->atlas.current;
        wall.last_scan = p->scans;
        p->map.wall[p->map.count - 1 - i / 10] = wall;
    }
    p->map.near_radius_um = 0;
}

enum class Known { claimed, nothing, place };

/* As many places as are kept, all near enough to be fitted to what is there, and scans of the way that what
 * is proposed is held against. */
void places(ale_relocation_t *relocation, const ale_pipeline_t *p, Random &random, Known known)
{
    ale_relocation_clear(relocation);
    for (int k = 0; k < ALE_TRAIL_SCANS; k++) {
        ale_trail_follow(&relocation->trail, {60 * centimetre_um, 0, 0});
        ale_trail_keep(&relocation->trail, p->observed.observation, p->observed.count);
    }
    relocation->count = ALE_PLACES;
    for (ale_place_t &place : relocation->place) {
        place = {any_motion(random).pose, 200, 0, 4};
    }
    if (known == Known::place) {
        relocation->place[0] = {{0, 0, 0}, 256, 256, 40};
    }
}

/* Around where the robot is said to be, or anywhere, or where one place is left: whether its own map lies
 * there. The poorer a scan, the more places are fitted to it. */
void search(Parts &parts, Random &random, Lost &lost)
{
    for (uint32_t views = 4; views <= ALE_MAX_OBSERVATIONS; views += 4) {
        for (const Known known : {Known::claimed, Known::nothing, Known::place}) {
            ale_pipeline_t *p = lost(views);
            own_map(p);
            p->searched = false;
            p->claims = known == Known::claimed ? 2 : 0;
            places(&p->relocation, p, random, known);
            const ale_prediction_t prediction = lost.prediction(any_motion(random));
            parts.measure("lost: an older map searched", 1, [&] { ale_step_search(p, &prediction); });
        }
    }
}

/* The scan confirms where the robot is, and what its own scans have looked through is asked; whatever they
 * say, the maps join then. All marks are of its own map, which moves. */
void joining(Parts &parts, Lost &lost)
{
    for (uint32_t views = 4; views <= ALE_MAX_OBSERVATIONS; views += 8) {
        ale_pipeline_t *p = lost(views);
        for (ale_landmark_t &mark : p->map.landmarks.landmark) {
            mark.seen = 1;
            mark.map = 1;
        }
        ale_atlas_begin(&p->atlas);
        ale_motion_t there = p->motion;
        p->motion.pose = {500 * centimetre_um, 700 * centimetre_um, 123456789};
        p->map.near_radius_um = 0;
        way_back(p->way_back, ale_pipeline_seen_from(p, {0, 0, 0}, {0, 0, 0}));
        parts.measure("lost: two maps join", 1, [&] {
            ale_pipeline_fit(p, &there, 40000000, &p->other);
            ale_way_back_denied_um(&p->way_back, &p->map, {0, 0, 0}, there.pose);
            ale_maps_join(p, ALE_FIRST_MAP, &p->other);
        });
    }
}

/* On one line, aslant, whose whole length the edges of a box of tiles have to be compared with. */
constexpr ale_point_t on_the_line(int32_t metres)
{
    return {metres * 100 * centimetre_um, -metres * 100 * centimetre_um};
}

std::unique_ptr<ale_tile_change_t> piece_of_a_tile()
{
    auto piece = std::make_unique<ale_tile_change_t>();
    piece->last = true;
    piece->gone_count = piece->line_count = ALE_TILE_PIECE_WALLS;
    piece->corner_count = ALE_TILE_PIECE_CORNERS;
    for (uint32_t k = 0; k < ALE_TILE_PIECE_WALLS; k++) {
        piece->gone[k] = piece->line[k].id = k + 1;
        piece->line[k].start = on_the_line(-3);
        piece->line[k].end = on_the_line(-1);
        piece->line[k].var_rho_um2 = 9000000;
        piece->line[k].var_alpha_nrad2 = 9000000000000;
    }
    return piece;
}

/* The map is full of what the drive has seen, on the line of the walls that come, and facing as they do: none
 * of it is dismissed before the last test, and none is a part of them. It stays, or leaves with the tiles
 * around it, whose corner the line passes. */
void tiles(Parts &parts)
{
    const auto piece = piece_of_a_tile();
    auto map = std::make_unique<ale_local_map_t>();
    ale_wall_t wall;
    ale_map_line_wall(&piece->line[0], &wall);
    wall.anchor = on_the_line(2);
    for (const bool stays : {true, false}) {
        for (const bool confirmed : {false, true}) {
            wall.seen = confirmed ? ALE_MAP_CONFIRMED : 1;
            ale_local_map_clear(map.get());
            std::fill(std::begin(map->wall), std::end(map->wall), wall);
            for (ale_landmark_t &mark : map->landmarks.landmark) {
                mark.seen = 1;
            }
            map->count = ALE_MAP_MAX_LINES;
            map->corners.count = ALE_MAP_MAX_CORNERS;
            piece->window = {-100000000, -100000000, stays ? 100000000 : 1500000,
                             stays ? 100000000 : -2500000};
            parts.measure("a piece of a tile", 1, [&] { ale_tile_change_apply(map.get(), piece.get()); });
        }
    }
}

void corners(Parts &parts, Random &random)
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

/* Wheels at a thousand samples a second, on a way that turns; the lag's row has waited for all it may take.
 */
void wheels(Parts &parts)
{
    auto wheels = std::make_unique<ale_wheels_t>();
    ale_wheels_init(wheels.get(), 3000, 6000);
    ale_lag_t lag;
    ale_lag_init(&lag, 0);
    ale_wheel_errors_t errors = {35000, 20000, {}};
    ale_wheel_scale_init(&errors.scale, 50000);
    const auto turned = [](int64_t t_us) { return static_cast<uint32_t>(t_us * 700); };
    for (int64_t t_us = 0; t_us <= 1500000; t_us += 10000) {
        const ale_odometry_t sample = {t_us, {static_cast<int32_t>(t_us / 4), 0, turned(t_us)}};
        ale_wheels_add(wheels.get(), &sample);
    }
    for (int64_t t_us = 0; t_us <= 1500000; t_us += 100000) {
        const ale_heading_t heading = {t_us, turned(t_us), 65536};
        ale_lag_add_heading(&lag, &heading);
    }
    lag.done_us = 500000;
    ale_wheel_motion_t motion;
    /* since the last scan and, where it was waited from, since one has told the pose */
    parts.measure("way of the wheels", 2,
                  [&] { ale_wheel_motion(wheels.get(), &lag, &errors, 300000, 1450000, &motion); });
    ale_pose_t unwatched;
    int32_t beyond_us;
    parts.measure("way through a time unwatched", 1,
                  [&] { ale_wheels_motion(wheels.get(), 300000, 400000, &unwatched, &beyond_us); });
    parts.measure("lag of the wheels", 1, [&] { ale_lag_update(&lag, wheels.get()); });
}

/* Prediction, answer and what else a scan of any size asks for: a dropped one needs it too. */
void always(Parts &parts)
{
    const ale_pipeline_config_t config = ale_pipeline_default_config();
    auto pipeline = std::make_unique<ale_pipeline>();
    ale_pipeline_init(pipeline.get(), &config);
    Random random(4);
    const ale_scan_t scan = any_scan(random);
    ale_estimate_t estimate;
    ale_pipeline_scan(pipeline.get(), &scan, &estimate);
    parts.measure("prediction and answer", 1,
                  [&] { ale_pipeline_dropped(pipeline.get(), scan.stamp_us + 100000, &estimate); });
    const ale_motion_t by_wheels = pipeline->motion;
    ale_ways_t ways;
    /* and by wheels, where it was waited from */
    parts.measure("going on as before", 2, [&] {
        ale_motion_t as_before = by_wheels;
        ale_pipeline_predict_motion(pipeline.get(), &as_before, by_wheels.stamp_us + 100000, nullptr);
        ways = ale_ways_of(&by_wheels, &as_before, true);
    });
}

} // namespace

Bound bound_of_a_scan(InstructionCounter &counter)
{
    Parts any_scan(counter);
    Parts tracked(counter);
    Parts lost(counter);
    Parts one_of(counter);
    looking(any_scan);
    wheels(any_scan);
    always(any_scan);
    for (unsigned seed = 0; seed < seeds; seed++) {
        Random random(seed);
        for (const uint8_t kind : {ALE_OBSERVATION_LINE, ALE_OBSERVATION_SEGMENT, ALE_OBSERVATION_POINT}) {
            Crowd crowd(random, kind, seed % 2 == 1, seed % 4 < 2 ? ALE_MAP_MAX_LINES : ALE_MAX_OBSERVATIONS);
            matching(tracked, random, crowd);
            witnesses(tracked, random, crowd);
        }
    }
    for (unsigned seed = 0; seed < seeds; seed++) {
        Random random(seed);
        Crowd crowd(random, ALE_OBSERVATION_LINE, seed % 2 == 1,
                    seed % 4 < 2 ? ALE_MAP_MAX_LINES : ALE_MAX_OBSERVATIONS);
        Lost robot(random, crowd);
        beginning(lost, robot);
        recovery(one_of, random, robot);
        search(one_of, random, robot);
        joining(one_of, robot);
    }
    Random random(5);
    corners(tracked, random);
    tiles(one_of);
    return {any_scan.take(), tracked.take(), lost.take(), one_of.take()};
}

} // namespace bench
