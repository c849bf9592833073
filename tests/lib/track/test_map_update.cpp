// lib/track/map_update: walls and landmarks sharpened and begun, against a scalar Kalman filter in double.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "track/map_update.h"
}

namespace
{

const double pi = reference::pi;

/* A line seen from the origin, facing it: at `distance` along x, from y = -half to half. */
ale_observation_t line_at(double distance, double half = 1.0, double sigma = 0.004)
{
    ale_observation_t o = {};
    o.centre = {convert::um(distance), 0};
    o.normal_bam = convert::bam(pi);
    o.start_um = convert::um(-half);
    o.end_um = convert::um(half);
    o.var_offset_um2 = std::llround(sigma * sigma * 1e12);
    o.var_angle_urad2 = 9000000;
    o.kind = ALE_OBSERVATION_LINE;
    return o;
}

struct Map {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_fit_t> fit = std::make_unique<ale_fit_t>();
    ale_map_uncertainty_t here = {};
    ale_scale_error_t scale_error = {0, 0};
    ale_map_update_context_t context = {1, &here, &scale_error, 1, true};

    Map()
    {
        ale_local_map_clear(map.get());
        for (int i = 0; i < 3; i++) {
            fit->motion.cov.m[i][i] = 1000000; /* (1 mm)^2, (1 mrad)^2 */
        }
    }

    /* The observations go in as what they are associated with: walls by index, ALE_NO_WALL where none. */
    void take(const std::vector<ale_observation_t> &seen, const std::vector<uint16_t> &walls)
    {
        const ale_point_t origin = {0, 0};
        ale_local_map_approach(map.get(), origin, 20000000);
        ale_local_map_focus(map.get(), origin, 20000000);
        for (size_t i = 0; i < seen.size(); i++) {
            fit->association[i] = {.wall = walls[i], .landmark = ALE_NO_LANDMARK, .error = {}};
            if (walls[i] != ALE_NO_WALL) {
                fit->association[i].error = ale_wall_error(&map->wall[walls[i]], &seen[i]);
            }
        }
        ale_map_update(map.get(), seen.data(), static_cast<uint32_t>(seen.size()), fit.get(), &context);
        context.scan++;
    }
};

double sigma2(const ale_wall_t &wall)
{
    return static_cast<double>(wall.var_offset_um2) * 1e-12;
}

TEST(MapUpdate, ALineThatFoundNoWallBeginsOneWithTheVarianceOfPoseAndLine)
{
    Map m;
    m.take({line_at(2)}, {ALE_NO_WALL});
    ASSERT_EQ(m.map->count, 1);
    const ale_wall_t &wall = m.map->wall[0];
    EXPECT_NEAR(wall.anchor.x_um, 2000000, 2);
    EXPECT_EQ(wall.seen, 1U);
    EXPECT_NEAR(sigma2(wall), 16e-6 + 1e-6, 1e-9);
    EXPECT_EQ(wall.end_um - wall.start_um, 2000000);
}

TEST(MapUpdate, ObservationsSharpenAWallAsAKalmanFilterInDoubleDoes)
{
    Map m;
    m.take({line_at(2)}, {ALE_NO_WALL});
    double offset = 2.0;
    double variance = sigma2(m.map->wall[0]);
    const double measured = 16e-6 + 1e-6;
    for (int k = 0; k < 40; k++) {
        const double z = 2.0 + 0.003 * std::sin(k);
        m.take({line_at(z)}, {0});
        const double gain = variance / (variance + measured);
        offset += gain * (z - offset);
        variance *= 1 - gain;
    }
    const ale_wall_t &wall = m.map->wall[0];
    EXPECT_EQ(m.map->count, 1);
    EXPECT_EQ(wall.seen, 41U);
    EXPECT_NEAR(wall.anchor.x_um * 1e-6, offset, 20e-6);
    EXPECT_NEAR(sigma2(wall) / variance, 1.0, 0.02);
}

TEST(MapUpdate, DilutedObservationsWeighAsTheirShareOfOne)
{
    Map whole;
    Map diluted;
    whole.take({line_at(2)}, {ALE_NO_WALL});
    diluted.take({line_at(2)}, {ALE_NO_WALL});
    diluted.context.dilution = 50;
    whole.take({line_at(2.004)}, {0});
    for (int k = 0; k < 50; k++) {
        diluted.take({line_at(2.004)}, {0});
    }
    EXPECT_NEAR(diluted.map->wall[0].anchor.x_um, whole.map->wall[0].anchor.x_um, 60);
    EXPECT_NEAR(sigma2(diluted.map->wall[0]) / sigma2(whole.map->wall[0]), 1.0, 0.03);
}

TEST(MapUpdate, AWallIsWidenedToWhatIsSeenOfIt)
{
    Map m;
    m.take({line_at(2, 0.5)}, {ALE_NO_WALL});
    m.take({line_at(2, 1.5)}, {0});
    EXPECT_NEAR(m.map->wall[0].end_um - m.map->wall[0].start_um, 3000000, 2);
}

TEST(MapUpdate, NothingBeginsWhereTheMapMayNotGrowOrAWallIsNear)
{
    Map m;
    m.take({line_at(2)}, {ALE_NO_WALL});
    m.take({line_at(2.03)}, {ALE_NO_WALL}); /* may be the same wall: better none than two of it */
    EXPECT_EQ(m.map->count, 1);
    m.context.grow = false;
    m.take({line_at(4)}, {ALE_NO_WALL});
    EXPECT_EQ(m.map->count, 1);
    m.context.grow = true;
    m.take({line_at(4)}, {ALE_NO_WALL});
    EXPECT_EQ(m.map->count, 2);
}

TEST(MapUpdate, ShortLinesAndSegmentsLeaveLandmarksAndNoWalls)
{
    Map m;
    ale_observation_t segment = line_at(3, 0.05);
    segment.kind = ALE_OBSERVATION_SEGMENT;
    m.take({line_at(2, 0.1), segment}, {ALE_NO_WALL, ALE_NO_WALL});
    EXPECT_EQ(m.map->count, 0);
    for (const double x : {2.0, 3.0}) {
        const int32_t found =
            ale_landmarks_find(&m.map->landmarks, {convert::um(x), 0}, convert::bam(pi), false, 50000);
        ASSERT_NE(found, ALE_NO_LANDMARK);
        EXPECT_EQ(m.map->landmarks.landmark[found].seen, 1);
    }
}

TEST(MapUpdate, WallsAreBornWithTheUncertaintyOfTheMapAndTheScaleErrorOfThePose)
{
    Map m;
    m.here.xx_um2 = 400000000; /* (20 mm)^2 */
    m.scale_error = {5000, -7000};
    m.take({line_at(2)}, {ALE_NO_WALL});
    const ale_wall_t &wall = m.map->wall[0];
    EXPECT_GE(wall.map_uncertainty.xx_um2, 400000000);
    EXPECT_NEAR(wall.scale_error_um, -5000, 2); /* along its normal, which faces -x */
}

TEST(MapUpdate, OneWallThatWasSeenAsTwoIsJoined)
{
    Map m;
    m.take({line_at(2, 1.0)}, {ALE_NO_WALL});
    ale_wall_t twin = m.map->wall[0];
    twin.anchor.x_um += 3000;
    ale_local_map_add(m.map.get(), &twin);
    m.take({line_at(2, 1.0)}, {0});
    EXPECT_EQ(m.map->count, 1);
}

} // namespace
