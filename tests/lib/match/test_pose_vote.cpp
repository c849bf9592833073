// lib/match/pose_vote.c: where in a region a scan was taken, in random rooms.
#include "lib/map/walls.h"
#include "lib/observe/look.h"

extern "C" {
#include "match/pose_vote.h"
}

namespace
{

constexpr int32_t any_heading_urad = 3141592;
constexpr int32_t headings = ALE_VOTE_HEADINGS;
constexpr int32_t coarse_um = ALE_GRID_POOL * ALE_GRID_CELL_UM;
constexpr int32_t fine_um = ALE_VOTE_SIDE / 2 * ALE_GRID_CELL_UM; /* the fine search, to either side */
constexpr int32_t most_um = ALE_VOTE_REACH_UM;
constexpr double heading_step = 2 * reference::pi / headings;

using Walls = std::vector<room::Wall>;

/* A room with three boxes against its walls, turned and shifted. */
Walls random_room(std::mt19937 &rng, const reference::Pose &at)
{
    std::uniform_real_distribution<double> unit(0, 1);
    const double a = 3 + 1.5 * unit(rng);
    const double b = 2 + unit(rng);
    Walls walls = {{-a, -b, a, -b}, {a, -b, a, b}, {a, b, -a, b}, {-a, b, -a, -b}};
    for (int k = 0; k < 3; k++) {
        const double x = -a + 2 * (a - 1) * unit(rng);
        const double w = 0.4 + 0.6 * unit(rng);
        const double h = 0.3 + 0.5 * unit(rng);
        const double side = k == 1 ? -1 : 1;
        walls.push_back({x, side * b, x, side * (b - h)});
        walls.push_back({x, side * (b - h), x + w, side * (b - h)});
        walls.push_back({x + w, side * (b - h), x + w, side * b});
    }
    for (room::Wall &w : walls) {
        const reference::Pose p = reference::compose(at, {w.x1, w.y1, 0});
        const reference::Pose q = reference::compose(at, {w.x2, w.y2, 0});
        w = {p[0], p[1], q[0], q[1]};
    }
    return walls;
}

std::unique_ptr<ale_local_map_t> map_of(const Walls &walls)
{
    auto map = std::make_unique<ale_local_map_t>();
    ale_local_map_clear(map.get());
    for (const room::Wall &w : walls) {
        const ale_wall_t wall = make_wall((w.x1 + w.x2) / 2, (w.y1 + w.y2) / 2,
                                          std::atan2(w.y2 - w.y1, w.x2 - w.x1) - reference::pi / 2,
                                          std::hypot(w.x2 - w.x1, w.y2 - w.y1) / 2);
        ale_local_map_add(map.get(), &wall);
    }
    return map;
}

struct Vote {
    std::unique_ptr<ale_pose_vote_t> vote = std::make_unique<ale_pose_vote_t>();
    ale_vote_region_t region = {};

    Vote(const Walls &walls, const room::Look &look, const reference::Pose &centre, double reach_m,
         int32_t reach_urad)
    {
        const auto map = map_of(walls);
        region = {convert::pose(centre), convert::um(reach_m), reach_urad};
        ale_local_map_approach(map.get(), {region.centre.x_um, region.centre.y_um}, 20000000);
        ale_pose_vote(vote.get(), map.get(), look.seen.observation, look.seen.observation_count, &region);
    }
    /* The first place that is this one; -1: none. */
    int rank(const reference::Pose &truth) const
    {
        for (uint32_t k = 0; k < vote->places; k++) {
            const reference::Pose error = room::since_start(truth, convert::pose(vote->place[k].pose));
            if (error.head<2>().norm() < 0.25 && std::abs(reference::wrap(error[2])) < heading_step) {
                return static_cast<int>(k);
            }
        }
        return -1;
    }
    /* The points that lie on surfaces when the scan is at a place, by the grid as it was drawn. */
    int32_t score_q8(ale_pose_t place) const
    {
        const ale_viewpoint_t viewpoint = ale_viewpoint(place);
        int32_t sum = 0;
        for (uint32_t k = 0; k < vote->points; k++) {
            const ale_point_t p = ale_minus(ale_point_from(vote->point[k], &viewpoint), vote->grid.corner);
            sum += vote->grid.fine[p.y_um / ALE_GRID_CELL_UM][p.x_um / ALE_GRID_CELL_UM];
        }
        return sum * 256 / (ALE_GRID_SURFACE * static_cast<int32_t>(vote->points));
    }
};

void check_order(const Vote &v)
{
    for (uint32_t k = 0; k < v.vote->places; k++) {
        const ale_voted_pose_t &place = v.vote->place[k];
        EXPECT_EQ(place.score_q8, v.score_q8(place.pose)) << k;
        EXPECT_LE(place.score_q8, 256);
        EXPECT_GT(place.score_q8, 0);
        EXPECT_TRUE(k == 0 || place.score_q8 <= v.vote->place[k - 1].score_q8) << k;
    }
}

void check_region(const Vote &v)
{
    const double most_m = (v.region.reach_um + coarse_um / 2 + fine_um) * 1e-6;
    const double most_rad = v.region.reach_urad * 1e-6 + 2 * heading_step;
    for (uint32_t k = 0; k < v.vote->places; k++) {
        const reference::Pose off = convert::pose(v.vote->place[k].pose) - convert::pose(v.region.centre);
        EXPECT_LE(std::abs(off[0]), most_m + 1e-6) << k;
        EXPECT_LE(std::abs(off[1]), most_m + 1e-6) << k;
        EXPECT_LE(std::abs(reference::wrap(off[2])), most_rad + 1e-6) << k;
    }
}

} // namespace

TEST(PoseVote, FindsTheTruePoseInRandomRooms)
{
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    const int rooms = 60;
    int first = 0;
    int among = 0;
    for (int k = 0; k < rooms; k++) {
        const Walls walls = random_room(rng, {30 * unit(rng), 30 * unit(rng), 3 * unit(rng)});
        const reference::Pose middle((walls[0].x1 + walls[2].x1) / 2, (walls[0].y1 + walls[2].y1) / 2, 0);
        const reference::Pose truth = middle + reference::Pose(unit(rng), unit(rng), 3 * unit(rng));
        const reference::Pose off(2 * unit(rng), 2 * unit(rng), 3.1 * unit(rng));
        const Vote v(walls, room::Look(walls, truth, truth), truth + off, 2.2, any_heading_urad);
        const int rank = v.rank(truth);
        first += rank == 0;
        among += rank >= 0 && rank < 4;
        check_order(v);
        check_region(v);
    }
    EXPECT_GE(first, 54);
    EXPECT_GE(among, 59);
}

TEST(PoseVote, NothingOutsideTheRegionIsFound)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < 30; k++) {
        const Walls walls = random_room(rng, {0, 0, unit(rng)});
        const reference::Pose truth(unit(rng), unit(rng), 3 * unit(rng));
        const reference::Pose off(0.3 * unit(rng), 0.3 * unit(rng), 0.3 * unit(rng));
        const Vote near(walls, room::Look(walls, truth, truth), truth + off, 0.4, 400000);
        check_region(near);
        EXPECT_EQ(near.rank(truth), 0) << k;
        const reference::Pose turned = truth + reference::Pose(0, 0, 1.6);
        const Vote elsewhere(walls, room::Look(walls, truth, truth), turned, 0.4, 400000);
        check_region(elsewhere);
        EXPECT_EQ(elsewhere.rank(truth), -1) << k;
    }
}

/* A rectangle looks the same after half a turn: both headings are named, and none is preferred by much. */
TEST(PoseVote, NamesBothHeadingsOfARoomThatIsTheSameAfterHalfATurn)
{
    const Walls walls = {{-4, -2.5, 4, -2.5}, {4, -2.5, 4, 2.5}, {4, 2.5, -4, 2.5}, {-4, 2.5, -4, -2.5}};
    const reference::Pose truth(0.6, -0.4, 0.7);
    const reference::Pose other(-0.6, 0.4, 0.7 + reference::pi);
    const room::Look look(walls, truth, truth);
    for (const double heading : {0.0, 0.7, 1.6, 3.1, -2.4}) {
        const Vote v(walls, look, {0, 0, heading}, 2, any_heading_urad);
        const int a = v.rank(truth);
        const int b = v.rank(other);
        ASSERT_GE(a, 0) << heading;
        ASSERT_GE(b, 0) << heading;
        EXPECT_NEAR(v.vote->place[a].score_q8, v.vote->place[b].score_q8, 30) << heading;
    }
}

TEST(PoseVote, AnEmptyScanAndAnEmptyMapNameNoPlace)
{
    const Walls walls = room::l_shape();
    room::Look look(walls, {1, 0, 0}, {1, 0, 0});
    EXPECT_EQ(Vote({}, look, {1, 0, 0}, 2, any_heading_urad).vote->places, 0U);
    look.seen.observation_count = 0;
    const Vote empty(walls, look, {1, 0, 0}, 2, any_heading_urad);
    EXPECT_EQ(empty.vote->places, 0U);
    EXPECT_EQ(empty.vote->points, 0U);
}

/* More surfaces than there are points, single points, and surfaces beyond the grid. */
TEST(PoseVote, ScansOfAnySizeAreSampledWithinTheCapacity)
{
    std::mt19937 rng(6);
    std::uniform_real_distribution<double> unit(-1, 1);
    const Walls walls = room::l_shape();
    for (const double half : {0.0, 0.02, 0.5, 12.0, 300.0}) {
        room::Look look(walls, {1, 0, 0}, {1, 0, 0});
        for (ale_observation_t &o : look.observations) {
            o = {};
            o.centre = {convert::um(20 * unit(rng)), convert::um(20 * unit(rng))};
            o.normal_bam = convert::bam(3 * unit(rng));
            o.end_um = convert::um(half);
            o.start_um = -o.end_um;
        }
        look.seen.observation_count = ALE_MAX_OBSERVATIONS;
        const Vote v(walls, look, {1, 0, 0}, most_um * 1e-6, any_heading_urad);
        EXPECT_GE(v.vote->points, uint32_t{ALE_MAX_OBSERVATIONS});
        EXPECT_LE(v.vote->points, uint32_t{ALE_VOTE_POINTS});
        EXPECT_LE(v.vote->places, uint32_t{ALE_VOTE_PLACES});
        check_region(v);
    }
}

/* At the ends of what a coordinate holds, and with the room at the border of the grid. */
TEST(PoseVote, IsTheSameAtTheEndsOfTheWorld)
{
    for (const double x : {-2120.0, 0.0, 2120.0}) {
        for (const double y : {-2120.0, 2120.0}) {
            std::mt19937 rng(7);
            const Walls walls = random_room(rng, {x, y, 0.3});
            const reference::Pose truth(x + 0.5, y - 0.4, 2);
            const room::Look look(walls, truth, truth);
            const Vote v(walls, look, {x, y, -1}, 2, any_heading_urad);
            EXPECT_EQ(v.rank(truth), 0) << x << " " << y;
            const Vote aside(walls, look, {x - std::copysign(7, x), y - std::copysign(7, y), -1}, 3.2,
                             any_heading_urad);
            check_region(aside);
        }
    }
}
