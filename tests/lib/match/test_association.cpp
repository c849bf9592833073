// lib/match/association.c and hypothesis.c against their twins in double, over random maps, poses and
// observations.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"
#include "reference/wall_match.h"

extern "C" {
#include "match/association.h"
#include "relocate/hypothesis.h"
}

namespace
{

using reference::Decisions;
using reference::Pose;
using reference::WallPiece;

// Walls about the origin in the integers' units and, from those, in the twin's.
class Scene
{
  public:
    explicit Scene(unsigned seed) : random(seed)
    {
        ale_local_map_clear(map.get());
        for (int k = 0; k < 24; k++) {
            const double facing = std::floor(uniform(0, 8)) * reference::pi / 4 + uniform(-0.05, 0.05);
            const double length = uniform(0.2, 3);
            const double y = uniform(-4, 4);
            const double x = uniform(-4, 4);
            const ale_observation_t observation = piece(x, y, facing, length, 1e-3, 2e-3);
            ale_wall_t wall;
            ale_wall_from_observation(&wall, &observation);
            wall.cov_um_urad = static_cast<int64_t>(uniform(-0.8, 0.8) * 1e3 * 2e3);
            wall.seen = 9;
            ale_local_map_add(map.get(), &wall);
            walls.push_back({metres(wall.anchor), convert::radians(wall.normal_bam), wall.start_um * 1e-6,
                             wall.end_um * 1e-6, static_cast<double>(wall.var_offset_um2) * 1e-12,
                             static_cast<double>(wall.var_angle_urad2) * 1e-12,
                             static_cast<double>(wall.cov_um_urad) * 1e-12});
        }
        ale_local_map_approach(map.get(), {0, 0}, 20000000);
    }

    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(random);
    }

    /* Drawn in an order of its own, not in the one in which a compiler evaluates arguments. */
    Pose somewhere()
    {
        const double theta = uniform(-3, 3);
        const double y = uniform(-2, 2);
        const double x = uniform(-2, 2);
        return {x, y, theta};
    }

    static ale_observation_t piece(double x, double y, double normal, double length, double sigma,
                                   double sigma_angle)
    {
        ale_observation_t v = {};
        v.centre = {convert::um(x), convert::um(y)};
        v.normal_bam = convert::bam(normal);
        v.start_um = convert::um(-0.45 * length);
        v.end_um = convert::um(0.55 * length);
        v.var_offset_um2 = std::llround(sigma * sigma * 1e12);
        v.var_angle_urad2 = std::llround(sigma_angle * sigma_angle * 1e12);
        v.kind = ALE_OBSERVATION_LINE;
        return v;
    }

    // What a robot at a pose sees of a wall: a part of it, with an error.
    ale_observation_t seen(size_t wall, const Pose &pose, double spread, double spread_angle)
    {
        const WallPiece &w = walls[wall];
        const double length = w.end - w.start;
        const Eigen::Vector2d tangent(std::sin(w.normal), -std::cos(w.normal));
        const Eigen::Vector2d normal(std::cos(w.normal), std::sin(w.normal));
        const Eigen::Vector2d p =
            w.centre + tangent * uniform(-0.3, 0.3) * length + normal * uniform(-spread, spread);
        const Eigen::Vector2d local = reference::rotation(-pose[2]) * (p - pose.head<2>());
        const double seen_length = length * uniform(0.3, 1);
        const double facing = w.normal - pose[2] + uniform(-spread_angle, spread_angle);
        return piece(local.x(), local.y(), facing, seen_length, 3e-3, 5e-3);
    }

    static WallPiece in_double(const ale_observation_t &v)
    {
        return {metres(v.centre),
                convert::radians(v.normal_bam),
                v.start_um * 1e-6,
                v.end_um * 1e-6,
                static_cast<double>(v.var_offset_um2) * 1e-12,
                static_cast<double>(v.var_angle_urad2) * 1e-12,
                0};
    }

    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::vector<WallPiece> walls;

  private:
    static Eigen::Vector2d metres(const ale_point_t &p)
    {
        return {p.x_um * 1e-6, p.y_um * 1e-6};
    }

    std::mt19937 random;
};

// A covariance with all correlations: of 3 cm and 3 degrees.
ale_matrix_t pose_covariance(Scene &scene, Eigen::Matrix3d &exact)
{
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; i++) {
        root(i / 3, i % 3) = scene.uniform(-0.03, 0.03);
    }
    const Eigen::Matrix3d wanted = root * root.transpose();
    ale_matrix_t cov = {};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            cov.m[i][j] = std::llround(wanted(i, j) * 1e12);
            exact(i, j) = static_cast<double>(cov.m[i][j]) * 1e-12;
        }
    }
    return cov;
}

} // namespace

// Bound: the same wall but where a distance lies within 1 % of a limit or of another wall's distance.
TEST(Match, TheWallThatAViewShowsIsThatOfTheTwin)
{
    int found = 0;
    int different = 0;
    for (unsigned seed = 0; seed < 100; seed++) {
        Scene scene(seed);
        for (size_t k = 0; k < scene.walls.size(); k++) {
            const ale_pose_t pose = convert::pose(scene.somewhere());
            const ale_observation_t observation = scene.seen(k, convert::pose(pose), 0.3, 0.15);
            Eigen::Matrix3d exact;
            const ale_matrix_t cov = pose_covariance(scene, exact);
            const ale_gate_t gate = {250000, 120000, 3, 0};
            Decisions decisions;
            const int twin = reference::wall_shown(scene.walls, Scene::in_double(observation),
                                                   convert::pose(pose), exact, {0.25, 0.12, 3}, decisions);
            const ale_viewpoint_t viewpoint = ale_viewpoint(pose);
            int32_t work = ALE_ASSOCIATION_WORK;
            ale_local_map_focus(scene.map.get(), {pose.x_um, pose.y_um}, 20000000);
            const ale_association_t association =
                ale_associate(scene.map.get(), &observation, &viewpoint, &cov, &gate, &work);
            const int wall = association.wall == ALE_NO_WALL ? -1 : association.wall;
            EXPECT_TRUE(wall == twin || decisions.nearest_miss() < 0.01)
                << "seed " << seed << ", wall " << k << ": " << wall << ", twin " << twin;
            found += twin >= 0 ? 1 : 0;
            different += wall == twin ? 0 : 1;
        }
    }
    EXPECT_GT(found, 800);
    EXPECT_LE(different, 5);
}

// Bound: 3 um and 3 urad, where the walls enclose 30 degrees or more.
TEST(Hypothesis, ThePoseOfAPairIsThatOfTheTwin)
{
    int compared = 0;
    for (unsigned seed = 0; seed < 100; seed++) {
        Scene scene(seed);
        for (size_t k = 0; k + 1 < scene.walls.size(); k++) {
            const Pose truth = scene.somewhere();
            const ale_observation_t a = scene.seen(k, truth, 0.02, 0.01);
            const ale_observation_t b = scene.seen(k + 1, truth, 0.02, 0.01);
            if (std::fabs(std::sin(scene.walls[k].normal - scene.walls[k + 1].normal)) < 0.5) {
                continue;
            }
            ale_pose_t pose;
            ASSERT_TRUE(ale_pose_of_pair(&a, &b, &scene.map->wall[k], &scene.map->wall[k + 1], &pose));
            const Pose twin = reference::pose_of_pair(Scene::in_double(a), Scene::in_double(b),
                                                      scene.walls[k], scene.walls[k + 1]);
            const Pose found = convert::pose(pose);
            EXPECT_LT((found.head<2>() - twin.head<2>()).norm(), 3e-6);
            EXPECT_NEAR(reference::wrap(found[2] - twin[2]), 0, 3e-6);
            compared++;
        }
    }
    EXPECT_GT(compared, 500);
}

// Small numbers take a way without wide products, large ones do not: both ways lead to the same variance.
TEST(Variance, IsThatOfTheTwinForNumbersOfAnySize)
{
    std::mt19937 rng(1);
    const auto of_size = [&](double least, double most) {
        return std::exp(std::uniform_real_distribution<double>(std::log(least), std::log(most))(rng));
    };
    const auto sign = [&] { return rng() % 2 == 0 ? 1.0 : -1.0; };
    for (int k = 0; k < 20000; k++) {
        ale_wall_t wall = {};
        wall.var_offset_um2 = std::llround(of_size(1e4, 1e12));
        wall.var_angle_urad2 = std::llround(of_size(2500, 4e12));
        wall.cov_um_urad = std::llround(
            sign() * of_size(1e-3, 1) *
            std::sqrt(static_cast<double>(wall.var_offset_um2) * static_cast<double>(wall.var_angle_urad2)));
        const int64_t t_um = std::llround(sign() * of_size(1e3, 1e8));
        const double t_m = static_cast<double>(t_um) * 1e-6;
        const double var = static_cast<double>(wall.var_offset_um2) +
                           2 * t_m * static_cast<double>(wall.cov_um_urad) +
                           t_m * t_m * static_cast<double>(wall.var_angle_urad2);
        const double size = std::fabs(t_m * static_cast<double>(wall.cov_um_urad)) +
                            t_m * t_m * static_cast<double>(wall.var_angle_urad2);
        EXPECT_NEAR(static_cast<double>(ale_wall_offset_var(&wall, t_um)), std::max(var, 1e4),
                    2 + std::fabs(t_m) + 1e-14 * size);

        ale_observation_t observation = {};
        observation.normal_bam = rng();
        observation.centre = {convert::um(sign() * of_size(0.01, 60)),
                              convert::um(sign() * of_size(0.01, 60))};
        const Eigen::Vector3d a(sign() * of_size(1e3, 1e6), sign() * of_size(1e3, 1e6),
                                sign() * of_size(100, 5e5));
        const Eigen::Vector3d b(sign() * of_size(1e2, 1e6), sign() * of_size(1e2, 1e6),
                                sign() * of_size(100, 5e5));
        ale_matrix_t cov = {};
        Eigen::Matrix3d twin;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                cov.m[i][j] = std::llround(a[i] * a[j] + b[i] * b[j]);
                twin(i, j) = static_cast<double>(cov.m[i][j]);
            }
        }
        const double normal = convert::radians(observation.normal_bam);
        const Eigen::Vector3d row(std::cos(normal), std::sin(normal),
                                  observation.centre.x_um * 1e-6 * std::sin(normal) -
                                      observation.centre.y_um * 1e-6 * std::cos(normal));
        const Eigen::Vector3d rounded(std::round(row[0] * 16384) / 16384, std::round(row[1] * 16384) / 16384,
                                      std::round(row[2] * 16384) / 16384);
        const double most = rounded.cwiseAbs().transpose() * twin.cwiseAbs() * rounded.cwiseAbs();
        EXPECT_NEAR(static_cast<double>(ale_observation_offset_var(&observation, &cov)),
                    rounded.transpose() * twin * rounded,
                    10 + 1e-4 * most + 1e-4 * std::sqrt(most * twin.maxCoeff()));
    }
}

// Every hypothesis has the twin's score to a millimetre, and when all pairs of walls were gone through the
// best of them is where the robot is.
TEST(Hypothesis, TheSearchFindsThePlaceAndTheScoresOfTheTwin)
{
    int found = 0;
    int compared = 0;
    for (unsigned seed = 0; seed < 160; seed++) {
        Scene scene(seed);
        const Pose truth = scene.somewhere();
        std::vector<ale_observation_t> observations;
        std::vector<WallPiece> lines;
        for (const size_t k : {0U, 3U, 6U, 9U, 12U, 15U, 18U, 21U}) {
            observations.push_back(scene.seen(k, truth, 0.003, 0.002));
            lines.push_back(Scene::in_double(observations.back()));
        }
        ale_search_t search = {};
        ale_hypothesis_t best = {};
        for (int scan = 0; scan < 100 && search.rounds == 0; scan++) {
            ale_hypothesis_t made[ALE_MAX_HYPOTHESES];
            const uint32_t count = ale_search(&search, scene.map.get(), observations.data(),
                                              static_cast<uint32_t>(observations.size()), made);
            for (uint32_t k = 0; k < count; k++) {
                Decisions decisions;
                const double twin =
                    reference::length_on_walls(scene.walls, lines, convert::pose(made[k].pose), decisions);
                EXPECT_TRUE(std::fabs(static_cast<double>(made[k].score_um) * 1e-6 - twin) < 1e-3 ||
                            decisions.nearest_miss() < 0.01)
                    << "seed " << seed << ": " << made[k].score_um << " um, twin " << twin << " m";
                best = made[k].score_um > best.score_um ? made[k] : best;
                compared++;
            }
        }
        found += (convert::pose(best.pose).head<2>() - truth.head<2>()).norm() < 0.1 ? 1 : 0;
    }
    EXPECT_GT(compared, 200);
    EXPECT_GE(found, 136);
}
