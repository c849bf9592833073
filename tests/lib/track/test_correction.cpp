// lib/track/correction, pipeline_mapper: the map moves as loops say, and what must not move does not.
#include <cstring>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "map/local_map.h"
#include "track/correction.h"
#include "track/keyframe.h"
#include "track/pipeline_state.h"
#include "track/scan_observation.h"
}

namespace
{

using Correction = std::unique_ptr<ale_correction_t>;

Correction correction_of(std::vector<std::pair<uint32_t, reference::Pose>> shifts, uint32_t epoch)
{
    auto c = std::make_unique<ale_correction_t>();
    c->epoch = epoch;
    for (const auto &[scan, shift] : shifts) {
        c->shift[c->count++] = {scan, convert::pose(shift)};
    }
    return c;
}

struct Driven {
    room::Pipeline pipeline;
    ale_estimate_t last = {};
    std::unique_ptr<ale_keyframe_t> keyframe = std::make_unique<ale_keyframe_t>();
    std::vector<uint32_t> keyframes; // their scans
    int next = 0;
    std::mt19937 rng{5};

    Driven() : pipeline(room::make(ale_pipeline_default_config()))
    {
    }

    void drive(int scans)
    {
        room::Sensor sensor;
        sensor.noise = 0.003;
        for (const int end = next + scans; next < end; next++) {
            const ale_scan_t scan = room::scan_at(room::l_shape(), sensor, room::path, 1 + 0.1 * next, rng);
            ale_pipeline_scan(pipeline.get(), &scan, &last);
            if (ale_pipeline_keyframe(pipeline.get(), keyframe.get())) {
                keyframes.push_back(keyframe->scan);
            }
        }
    }

    std::unique_ptr<ale_map_t> map() const
    {
        auto m = std::make_unique<ale_map_t>();
        ale_pipeline_copy_map(pipeline.get(), m.get());
        return m;
    }
};

double distance(ale_point_t a, const reference::Pose &shift, ale_point_t b)
{
    const reference::Pose p = reference::compose(shift, {a.x_um * 1e-6, a.y_um * 1e-6, 0});
    return std::hypot(p[0] - b.x_um * 1e-6, p[1] - b.y_um * 1e-6);
}

TEST(Correction, AScanMovesWithTheLastKeyframeBeforeIt)
{
    const Correction c = correction_of({{10, {1, 0, 0}}, {20, {2, 0, 0}}, {35, {3, 0, 0}}}, 1);
    for (const auto &[scan, x] : std::vector<std::pair<uint32_t, double>>{{0, 0},
                                                                          {9, 0},
                                                                          {10, 1},
                                                                          {19, 1},
                                                                          {20, 2},
                                                                          {34, 2},
                                                                          {35, 3},
                                                                          {4000000000U, 3},
                                                                          {ALE_BORN_BEFORE, 0}}) {
        EXPECT_EQ(ale_correction_at(c.get(), scan).x_um, convert::um(x)) << scan;
    }
}

TEST(Correction, IsNewsBeyondFiveMillimetresOrTwoMilliradians)
{
    const ale_point_t before = {1000000, -2000000};
    const auto is_news = [&](int32_t x_um, int32_t y_um, double turn_rad) {
        return ale_correction_is_news(before, {before.x_um + x_um, before.y_um + y_um},
                                      {0, 0, convert::bam(turn_rad)});
    };
    for (const int sign : {-1, 1}) {
        EXPECT_FALSE(is_news(sign * 5000, sign * 5000, sign * 0.00199)) << sign;
        EXPECT_TRUE(is_news(sign * 5001, 0, 0)) << sign;
        EXPECT_TRUE(is_news(0, sign * 5001, 0)) << sign;
        EXPECT_TRUE(is_news(0, 0, sign * 0.00201)) << sign;
    }
    EXPECT_TRUE(ale_correction_is_news({INT32_MIN, 0}, {INT32_MAX, 0}, {0, 0, 0})) << "from end to end";
}

TEST(Correction, KeyframesComeWithTheWayAndNotWithTime)
{
    Driven d;
    d.drive(120);
    ASSERT_GT(d.keyframes.size(), 5U);
    EXPECT_EQ(d.keyframes.front(), 0U);
    EXPECT_LT(d.keyframes.size(), 30U);
    EXPECT_FALSE(ale_pipeline_keyframe(d.pipeline.get(), d.keyframe.get()));
}

TEST(Correction, WallsCornersAndRobotMoveLikeTheTwinAndTheSmoothPoseDoesNot)
{
    Driven d;
    d.drive(80);
    const reference::Pose shift(0.4, -0.25, 0.1);
    const auto before = d.map();
    const ale_estimate_t at = d.last;
    ale_pipeline_correct(d.pipeline.get(), correction_of({{0, shift}}, d.keyframe->epoch).get());
    const auto after = d.map();
    ASSERT_EQ(before->line_count, after->line_count);
    ASSERT_GT(before->line_count, 6);
    for (int i = 0; i < before->line_count; i++) {
        EXPECT_LT(distance(before->line[i].start, shift, after->line[i].start), 3e-6);
        EXPECT_LT(distance(before->line[i].end, shift, after->line[i].end), 3e-6);
    }
    ASSERT_EQ(before->corner_count, after->corner_count);
    for (int i = 0; i < before->corner_count; i++) {
        EXPECT_LT(distance(before->corner[i].p, shift, after->corner[i].p), 3e-6);
    }
    d.drive(1);
    const reference::Pose moved = reference::compose(shift, convert::pose(at.map));
    EXPECT_LT((convert::pose(d.last.map) - moved).head<2>().norm(), 0.08);
    EXPECT_LT((convert::pose(d.last.smooth) - convert::pose(at.smooth)).head<2>().norm(), 0.08);
}

TEST(Correction, TrackingGoesOnAsIfNothingHadHappened)
{
    Driven plain;
    plain.drive(140);
    Driven bent;
    bent.drive(80);
    const reference::Pose shift(-0.3, 0.2, -0.15);
    ale_pipeline_correct(bent.pipeline.get(), correction_of({{0, shift}}, bent.keyframe->epoch).get());
    bent.drive(60);
    const reference::Pose expected = reference::compose(shift, convert::pose(plain.last.map));
    EXPECT_LT((convert::pose(bent.last.map) - expected).head<2>().norm(), 0.006);
    EXPECT_EQ(bent.last.state, ALE_STATE_GOOD);
    EXPECT_LE(bent.map()->line_count, plain.map()->line_count + 2);
}

TEST(Correction, WhileTheRobotSettlesTheLastScanStaysOnTheWayThatIsSmooth)
{
    Driven d;
    d.drive(80);
    const reference::Pose shift(0.04, 0.03, 0.02); // of the robot; nearly all walls were there before
    ale_pipeline_correct(d.pipeline.get(),
                         correction_of({{d.keyframe->scan, shift}}, d.keyframe->epoch).get());
    for (int k = 0; k < 3; k++) {
        d.drive(1);
        const ale_pipeline_t &p = *d.pipeline;
        ASSERT_GT(p.witness.observation_count, 0U);
        EXPECT_EQ(p.witness.seen.robot.x_um, d.last.smooth.x_um) << k;
        EXPECT_EQ(p.witness.seen.robot.y_um, d.last.smooth.y_um) << k;
        EXPECT_EQ(p.witness.seen.robot.theta_bam, d.last.smooth.theta_bam) << k;
    }
}

TEST(Correction, ACorrectionOfAnotherMapIsIgnored)
{
    Driven d;
    d.drive(20);
    const auto before = d.map();
    ale_pipeline_correct(d.pipeline.get(), correction_of({{0, {1, 1, 1}}}, d.keyframe->epoch + 1).get());
    const auto after = d.map();
    EXPECT_EQ(std::memcmp(before.get(), after.get(), sizeof *after), 0);
}

TEST(Correction, AFrozenMapStaysAsItIsByteForByte)
{
    Driven d;
    d.drive(60);
    ale_pipeline_freeze_map(d.pipeline.get(), true);
    const auto before = d.map();
    d.drive(60);
    const auto after = d.map();
    EXPECT_EQ(d.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(std::memcmp(before->line, after->line, sizeof after->line), 0);
    EXPECT_EQ(std::memcmp(before->corner, after->corner, sizeof after->corner), 0);
}

TEST(Correction, ARobotThatIsShownWhereItStandsGoesOnFromThere)
{
    Driven d;
    d.drive(60);
    const reference::Pose at = convert::pose(d.last.map);
    ale_pose_t wrong = convert::pose(reference::Pose(at[0] + 0.25, at[1] - 0.15, at[2] + 0.08));
    const ale_pose_t smooth = d.last.smooth;
    ale_pipeline_relocate(d.pipeline.get(), wrong);
    d.drive(1);
    EXPECT_LT((convert::pose(d.last.smooth) - convert::pose(smooth)).head<2>().norm(), 0.1);
    d.drive(9);
    const reference::Pose truth = room::since_start(room::path(1), room::path(1 + 0.1 * (d.next - 1)));
    EXPECT_LT((convert::pose(d.last.map) - truth).head<2>().norm(), 0.01);
    EXPECT_EQ(d.last.state, ALE_STATE_GOOD);
}

TEST(Sighting, ItHoldsWhatTheScanHasShownAndTheKeyframeItBelongsTo)
{
    Driven d;
    d.drive(20);
    auto scan_observation = std::make_unique<ale_scan_observation_t>();
    ASSERT_TRUE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
    EXPECT_EQ(scan_observation->scan, 19U);
    EXPECT_EQ(scan_observation->epoch, d.last.epoch);
    EXPECT_EQ(scan_observation->keyframe, d.keyframes.back());
    EXPECT_EQ(scan_observation->stamp_us, d.last.stamp_us);
    EXPECT_EQ(std::memcmp(&scan_observation->smooth, &d.last.smooth, sizeof(ale_pose_t)), 0);
    EXPECT_EQ(std::memcmp(&scan_observation->seen.robot, &d.last.map, sizeof(ale_pose_t)), 0);
    EXPECT_EQ(scan_observation->seen.scan.beams, 682);
    EXPECT_EQ(scan_observation->line_count, ale_pipeline_features(d.pipeline.get())->line_count);
    EXPECT_EQ(scan_observation->corner_count, ale_pipeline_features(d.pipeline.get())->corner_count);
}

TEST(Sighting, ThereIsNoneOfAScanThatWasLost)
{
    Driven d;
    d.drive(20);
    ale_pipeline_dropped(d.pipeline.get(), d.last.stamp_us + 100000, &d.last);
    auto scan_observation = std::make_unique<ale_scan_observation_t>();
    EXPECT_FALSE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
}

TEST(Sighting, ThereIsNoneForAMapThatIsFrozenOrWasLoaded)
{
    Driven d;
    d.drive(20);
    auto scan_observation = std::make_unique<ale_scan_observation_t>();
    ale_pipeline_freeze_map(d.pipeline.get(), true);
    EXPECT_FALSE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
    ale_pipeline_freeze_map(d.pipeline.get(), false);
    EXPECT_TRUE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
    ale_pipeline_load_map(d.pipeline.get(), d.map().get(), 1, d.last.map, true);
    d.drive(10);
    ASSERT_NE(d.last.state, ALE_STATE_LOST);
    ASSERT_TRUE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
    EXPECT_TRUE(scan_observation->loaded);
    ale_pipeline_reset(d.pipeline.get());
    d.drive(1);
    ASSERT_TRUE(ale_pipeline_scan_observation(d.pipeline.get(), scan_observation.get()));
    EXPECT_FALSE(scan_observation->loaded);
}

// Not even with its own first scan, where the robot was found at once.
TEST(Correction, AMapThatWasLoadedStaysWhereItIs)
{
    Driven d;
    d.drive(60);
    const auto loaded = d.map();
    ASSERT_GT(loaded->corner_count, 0);
    ale_pipeline_freeze_map(d.pipeline.get(), true);
    ale_pipeline_load_map(d.pipeline.get(), loaded.get(), 1, d.last.map, true);
    d.drive(20);
    ASSERT_NE(d.last.state, ALE_STATE_LOST);
    EXPECT_TRUE(d.keyframe->loaded);
    const auto before = d.map();
    const reference::Pose at = convert::pose(d.last.map);
    const reference::Pose shift(0.05, -0.03, 0.01);
    ASSERT_TRUE(ale_pipeline_correct(d.pipeline.get(), correction_of({{0, shift}}, d.keyframe->epoch).get()));
    const auto after = d.map();
    EXPECT_EQ(std::memcmp(before->line, after->line, sizeof before->line), 0);
    EXPECT_EQ(std::memcmp(before->corner, after->corner, sizeof before->corner), 0);
    ale_pipeline_dropped(d.pipeline.get(), d.last.stamp_us + 1, &d.last);
    EXPECT_GT((convert::pose(d.last.map) - at).head<2>().norm(), 0.02); // the robot is corrected
}

} // namespace

namespace
{

/* Two maps side by side: what was driven, and the same once more as map 1, elsewhere. */
struct TwoMaps : testing::Test {
    Driven d;
    ale_local_map_t &map = d.pipeline->map;
    std::unique_ptr<ale_landmarks_t> spare = std::make_unique<ale_landmarks_t>();
    std::unique_ptr<ale_local_map_t> before;
    std::mt19937 rng{3};

    void SetUp() override
    {
        d.drive(100);
        ale_landmarks_clear(&map.landmarks);
        add_landmarks(0, 60);
        ale_local_map_select(&map, 1);
        const uint16_t walls = map.count;
        for (uint16_t i = 0; i < walls; i++) {
            const ale_wall_t wall = map.wall[i];
            ale_local_map_add(&map, &wall);
        }
        ale_features_t f = {};
        f.corner_count = 3;
        for (int i = 0; i < 3; i++) {
            f.corner[i].p = {1000000 * i, 7000000};
        }
        ale_map_corners_update(&map.corners, &f, {0, 0, 0}, 90, true);
        add_landmarks(1, 60);
        before = std::make_unique<ale_local_map_t>(map);
    }
    void add_landmarks(uint8_t number, int count)
    {
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int k = 0; k < count; k++) {
            ale_landmark_t m = {};
            m.p = {convert::um(20 * unit(rng)), convert::um(20 * unit(rng))};
            m.normal_bam = convert::bam(3 * unit(rng));
            m.var_um2 = 9000000;
            m.seen = 2;
            m.map = number;
            m.born = 50;
            ale_landmarks_add(&map.landmarks, &m);
        }
    }
    void join(uint8_t from, uint8_t into, ale_pose_t shift, const ale_map_uncertainty_t &uncertainty = {})
    {
        const ale_local_map_join_t join = {from, into, shift, uncertainty};
        ale_local_map_join(&map, &join, spare.get());
    }
    static reference::Pose random_shift(std::mt19937 &rng)
    {
        std::uniform_real_distribution<double> unit(-1, 1);
        return {30 * unit(rng), 30 * unit(rng), reference::pi * unit(rng)};
    }
    int landmarks_found(const ale_local_map_t &of, uint8_t number, const reference::Pose &shift) const
    {
        int found = 0;
        for (const ale_landmark_t &m : before->landmarks.landmark) {
            if (m.seen == 0 || m.map != number) {
                continue;
            }
            const reference::Pose p =
                reference::compose(shift, {m.p.x_um * 1e-6, m.p.y_um * 1e-6, convert::radians(m.normal_bam)});
            found += ale_landmarks_find(&of.landmarks, {convert::um(p[0]), convert::um(p[1])},
                                        convert::bam(p[2]), false, 10) != ALE_NO_LANDMARK;
        }
        return found;
    }
};

TEST_F(TwoMaps, AJoinMovesAllOfTheOneLikeTheTwinAndNothingOfTheOther)
{
    const reference::Pose shift(4, -7, 2);
    const ale_map_uncertainty_t uncertainty = {1000000, 2, 3000000, 4, 5, 6000000};
    join(1, 0, convert::pose(shift), uncertainty);
    for (int i = 0; i < map.count; i++) {
        const ale_wall_t &was = before->wall[i];
        const ale_wall_t &is = map.wall[i];
        const bool moved = was.map == 1;
        const reference::Pose by = moved ? shift : reference::Pose(0, 0, 0);
        EXPECT_EQ(is.map, 0) << i;
        EXPECT_EQ(is.id, was.id) << i;
        for (const int32_t t_um : {was.start_um, was.end_um}) {
            EXPECT_LT(distance(ale_wall_point(&was, t_um), by, ale_wall_point(&is, t_um)), 5e-6) << i;
        }
        EXPECT_EQ(is.map_uncertainty.tt_urad2, moved ? uncertainty.tt_urad2 : was.map_uncertainty.tt_urad2);
        EXPECT_EQ(is.map_uncertainty.xx_um2, moved ? uncertainty.xx_um2 : was.map_uncertainty.xx_um2);
        EXPECT_TRUE(moved ? is.var_offset_um2 > was.var_offset_um2 : is.var_offset_um2 == was.var_offset_um2);
    }
    for (int i = 0; i < map.corners.count; i++) {
        const reference::Pose by = before->corners.map[i] == 1 ? shift : reference::Pose(0, 0, 0);
        EXPECT_EQ(map.corners.map[i], 0);
        EXPECT_LT(distance(before->corners.corner[i].p, by, map.corners.corner[i].p), 3e-6) << i;
    }
    EXPECT_GT(map.version, before->version);
    ale_local_map_select(&map, 0);
    EXPECT_EQ(landmarks_found(map, 1, shift), 60);
    EXPECT_EQ(landmarks_found(map, 0, {0, 0, 0}), 60);
    ale_local_map_approach(&map, {0, 0}, 60000000);
    EXPECT_EQ(map.near_first[ALE_MAP_DIRECTIONS], map.count);
}

/* By a shift and by its inverse: the map is where it was to the rounding, which does not grow. */
TEST_F(TwoMaps, AJoinAndItsInverseLeaveTheMapWhereItWas)
{
    for (int trial = 0; trial < 20; trial++) {
        const reference::Pose shift = random_shift(rng);
        join(1, 2, convert::pose(shift));
        join(2, 1, convert::pose(reference::inverse(convert::pose(convert::pose(shift)))));
    }
    for (int i = 0; i < map.count; i++) {
        EXPECT_EQ(map.wall[i].map, before->wall[i].map);
        const double most = before->wall[i].map == 1 ? 60e-6 : 0;
        EXPECT_LE(distance(map.wall[i].anchor, {0, 0, 0}, before->wall[i].anchor), most) << i;
        EXPECT_LE(std::abs(ale_bam_diff(map.wall[i].normal_bam, before->wall[i].normal_bam)),
                  most > 0 ? 40 : 0);
        EXPECT_EQ(map.wall[i].end_um, before->wall[i].end_um);
    }
    for (int i = 0; i < map.corners.count; i++) {
        EXPECT_LE(distance(map.corners.corner[i].p, {0, 0, 0}, before->corners.corner[i].p), 60e-6) << i;
    }
}

TEST_F(TwoMaps, AMapThatIsNotThereJoinsNothing)
{
    join(5, 0, convert::pose(reference::Pose(1, 2, 3)));
    for (int i = 0; i < map.count; i++) {
        EXPECT_EQ(std::memcmp(&map.wall[i], &before->wall[i], sizeof map.wall[i]), 0) << i;
    }
}

} // namespace
