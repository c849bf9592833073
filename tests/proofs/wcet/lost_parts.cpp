#include "proofs/wcet/parts.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofs/wcet/scans.hpp"

extern "C" {
#include "map/map_exchange.h"
#include "map/tile_change.h"
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

constexpr int32_t centimetre_um = 10000;

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

} // namespace

void count_lost(Parts &lost, Parts &one_of, Random &random, const Crowd &crowd)
{
    Lost robot(random, crowd);
    beginning(lost, robot);
    recovery(one_of, random, robot);
    search(one_of, random, robot);
    joining(one_of, robot);
}

/* The map is full of what the drive has seen, on the line of the walls that come, and facing as they do: none
 * of it is dismissed before the last test, and none is a part of them. It stays, or leaves with the tiles
 * around it, whose corner the line passes. */
void count_tiles(Parts &parts)
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

} // namespace bench
