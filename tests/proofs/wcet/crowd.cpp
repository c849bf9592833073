#include "proofs/wcet/crowd.hpp"

#include "proofs/wcet/scans.hpp"

extern "C" {
#include "base/trig.h"
}

namespace bench
{

namespace
{

constexpr double full_turn_bam = 4294967296.0;
constexpr int32_t piece_um = 160000;
constexpr int32_t mark_spacing_um = 100000;
constexpr int32_t sight_um = 30000000;

/* A surface around the robot. */
ale_observation_t any_view(Random &random, uint8_t kind, bool square)
{
    const uint32_t from_bam =
        square ? (random.chance(0.5) ? 0 : ALE_BAM_QUARTER_TURN) : any_direction(random);
    ale_observation_t v{};
    v.centre = ale_polar(micrometres(random.uniform(1, 5)), from_bam);
    v.normal_bam = from_bam + ALE_BAM_HALF_TURN;
    v.end_um = kind == ALE_OBSERVATION_LINE ? micrometres(random.uniform(0.3, 2)) : piece_um / 2;
    v.start_um = -v.end_um;
    v.var_offset_um2 = 9000000;
    v.var_angle_urad2 = 9000000;
    v.start_time_us = -10000;
    v.end_time_us = 10000;
    v.kind = kind;
    return v;
}

} // namespace

uint32_t any_direction(Random &random)
{
    return static_cast<uint32_t>(random.uniform(0, full_turn_bam));
}

Crowd::Crowd(Random &random, uint8_t kind, bool square, int walls)
{
    ale_local_map_clear(map.get());
    for (int k = 0; k < ALE_MAX_OBSERVATIONS; k++) {
        views.push_back(any_view(random, kind, square));
        if (kind == ALE_OBSERVATION_LINE) {
            add_wall(views.back());
        }
        add_marks(views.back());
    }
    for (int k = ALE_MAX_OBSERVATIONS; k < walls; k++) {
        add_wall(any_view(random, ALE_OBSERVATION_LINE, square));
    }
    ale_local_map_approach(map.get(), {0, 0}, sight_um);
}

void Crowd::add_wall(const ale_observation_t &view)
{
    ale_wall_t wall;
    ale_wall_from_observation(&wall, &view);
    wall.seen = ALE_MAP_CONFIRMED;
    ale_local_map_add(map.get(), &wall);
}

/* Nine all around it, as many of each place as are kept. */
void Crowd::add_marks(const ale_observation_t &view)
{
    for (int k = 0; k < 9; k++) {
        const ale_point_t place = {view.centre.x_um + (k % 3 - 1) * mark_spacing_um,
                                   view.centre.y_um + (k / 3 - 1) * mark_spacing_um};
        const ale_landmark_t mark = {
            place, view.normal_bam, 0, 9000000, 1, view.kind == ALE_OBSERVATION_POINT, 0, 0};
        for (int way = 0; way < ALE_LANDMARK_WAYS; way++) {
            ale_landmarks_add(&map->landmarks, &mark);
        }
    }
}

ale_motion_t any_motion(Random &random)
{
    ale_motion_t motion;
    ale_motion_init(&motion, 0,
                    {micrometres(random.uniform(-0.03, 0.03)), micrometres(random.uniform(-0.03, 0.03)),
                     static_cast<uint32_t>(static_cast<int32_t>(random.uniform(-8e6, 8e6)))},
                    300, 500);
    for (int i = 0; i < 3; i++) {
        motion.cov.m[i][i] = 900000000;
        motion.velocity[i] = 5000;
    }
    return motion;
}

} // namespace bench
