#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "reference/corner_of_lines.h"

extern "C" {
#include "base/trig.h"
#include "extract/corner.h"
#include "extract/extract.h"
}

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr int64_t step_nrad = 6135923; // of the URG-04LX

uint32_t bam(double radians)
{
    return static_cast<uint32_t>(static_cast<int64_t>(std::llround(radians / pi * 2147483648.0)));
}

ale_point_t point(const Eigen::Vector2d &p)
{
    return {static_cast<int32_t>(std::lround(p.x())), static_cast<int32_t>(std::lround(p.y()))};
}

// A wall from one point to another (um), with a covariance of (alpha, rho) in (nrad, um).
struct Wall {
    ale_line_t line;
    reference::Line exact;
};

Wall wall(const Eigen::Vector2d &from, const Eigen::Vector2d &to, int64_t var_alpha, int64_t cov,
          int64_t var_rho)
{
    Wall w{};
    const Eigen::Vector2d d = (to - from).normalized();
    Eigen::Vector2d n(-d.y(), d.x());
    n = n.dot(from) < 0 ? Eigen::Vector2d(-n) : n;
    w.line.alpha_bam = bam(std::atan2(n.y(), n.x()));
    w.line.rho_um = static_cast<int32_t>(std::lround(n.dot(from)));
    w.line.start = point(from);
    w.line.end = point(to);
    w.line.rmse_um = 5000;
    w.line.var_alpha_nrad2 = var_alpha;
    w.line.cov_alpha_rho = cov;
    w.line.var_rho_um2 = var_rho;
    w.exact.alpha = static_cast<int32_t>(w.line.alpha_bam) * (pi / 2147483648.0);
    w.exact.rho = w.line.rho_um;
    w.exact.cov << static_cast<double>(var_alpha) * 1e-18, static_cast<double>(cov) * 1e-9,
        static_cast<double>(cov) * 1e-9, static_cast<double>(var_rho);
    return w;
}

std::unique_ptr<ale_features_t> found(const ale_line_t &a, const ale_line_t &b, int gap_beams = 1)
{
    auto features = std::make_unique<ale_features_t>();
    features->line_count = 2;
    features->line[0] = a;
    features->line[0].first = 0;
    features->line[0].last = 50;
    features->line[1] = b;
    features->line[1].first = static_cast<uint16_t>(50 + gap_beams);
    features->line[1].last = 150;
    ale_corner_find(step_nrad, 0, features.get());
    return features;
}

// Bound between the two: 8 um in place; one part in a thousand and 4 um^2 in covariance.
TEST(Corner, place_and_covariance_agree_with_the_double_precision_twin)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 3000; k++) {
        const double bearing = 2 * pi * uniform(random);
        const double range = 3e5 + 5e6 * uniform(random);
        const Eigen::Vector2d p(range * std::cos(bearing), range * std::sin(bearing));
        const double first = 2 * pi * uniform(random);
        const double second = first + (20 + 140 * uniform(random)) * pi / 180 * (k % 2 ? 1 : -1);
        const double length = 3e5 + 2e6 * uniform(random);
        const Eigen::Vector2d a(p.x() + length * std::cos(first), p.y() + length * std::sin(first));
        const Eigen::Vector2d b(p.x() + length * std::cos(second), p.y() + length * std::sin(second));
        const auto var_alpha = static_cast<int64_t>(1e12 + 1e14 * uniform(random));
        const auto var_rho = static_cast<int64_t>(1e6 + 1e8 * uniform(random));
        const auto cov =
            static_cast<int64_t>((uniform(random) - 0.5) *
                                 std::sqrt(static_cast<double>(var_alpha) * static_cast<double>(var_rho)));
        const Wall wa = wall(a, p, var_alpha, cov, var_rho);
        const Wall wb = wall(p, b, var_alpha / 2, -cov / 2, var_rho / 3);
        const auto features = found(wa.line, wb.line);
        ASSERT_EQ(features->corner_count, 1) << "case " << k;
        const ale_corner_t &corner = features->corner[0];
        const reference::Corner exact = reference::corner_of_lines(wa.exact, wb.exact);
        EXPECT_NEAR(corner.p.x_um, exact.p.x(), 8) << "case " << k;
        EXPECT_NEAR(corner.p.y_um, exact.p.y(), 8) << "case " << k;
        const double scale = 1e-3 * (exact.cov(0, 0) + exact.cov(1, 1)) + 4;
        EXPECT_NEAR(static_cast<double>(corner.cov_um2[0]), exact.cov(0, 0), scale) << "case " << k;
        EXPECT_NEAR(static_cast<double>(corner.cov_um2[1]), exact.cov(0, 1), scale) << "case " << k;
        EXPECT_NEAR(static_cast<double>(corner.cov_um2[2]), exact.cov(1, 1), scale) << "case " << k;
        EXPECT_NEAR(corner.angle_bam * (pi / 2147483648.0), std::abs(second - first), 1e-5) << "case " << k;
    }
}

TEST(Corner, a_corner_of_a_room_is_concave_and_of_a_box_convex)
{
    const Wall right = wall({1e6, -1e6}, {1e6, 1e6}, 1, 0, 1);
    const Wall back = wall({1e6, 1e6}, {-1e6, 1e6}, 1, 0, 1);
    const auto room = found(right.line, back.line);
    ASSERT_EQ(room->corner_count, 1);
    EXPECT_EQ(room->corner[0].kind, ALE_CORNER_CONCAVE);
    const Wall side = wall({2e6, 5e5}, {1e6, 5e5}, 1, 0, 1);
    const Wall front = wall({1e6, 5e5}, {1e6, 2e6}, 1, 0, 1);
    const auto box = found(side.line, front.line);
    ASSERT_EQ(box->corner_count, 1);
    EXPECT_EQ(box->corner[0].kind, ALE_CORNER_CONVEX);
}

// The first wall is seen 100 mm past the second: a beam is 14 mm wide there, so this is a corner only where
// walls are 20 mm rough.
TEST(Corner, a_wall_that_is_seen_past_the_other_ends_at_no_corner)
{
    Wall a = wall({1e6, -5e5}, {1e6, 9e5}, 1000000000000, 0, 1000000);
    Wall b = wall({8.7e5, 8e5}, {-1e6, 8e5}, 1000000000000, 0, 1000000);
    EXPECT_EQ(found(a.line, b.line)->corner_count, 0);
    a.line.rmse_um = 20000;
    b.line.rmse_um = 20000;
    EXPECT_EQ(found(a.line, b.line)->corner_count, 1);
}

// Two walls of 1 m at right angles at (2, 1) m, the corner known to 10 and 20 mm along them: their ends lie
// half way between the beams that see them, give or take as little as neither sees.
TEST(Corner, facing_ends_are_known_as_well_as_their_beams_are_apart_and_the_walls_meet)
{
    const Eigen::Vector2d p(2e6, 1e6);
    const Wall a = wall({2e6, 0}, p, 1, 0, 400000000);
    const Wall b = wall(p, {1e6, 1e6}, 1, 0, 100000000);
    const double across = p.norm() * static_cast<double>(step_nrad) * 1e-9;
    for (const int gap : {1, 2, 4}) {
        const auto features = found(a.line, b.line, gap);
        const double share = (3 * gap * gap + 1) / 12.0;
        const double along_a = std::pow(across * p.norm() / p.x(), 2) * share + 1e8;
        const double along_b = std::pow(across * p.norm() / p.y(), 2) * share + 4e8;
        EXPECT_NEAR(static_cast<double>(features->line[0].var_end_um2), along_a, 1e-3 * along_a) << gap;
        EXPECT_NEAR(static_cast<double>(features->line[1].var_start_um2), along_b, 1e-3 * along_b) << gap;
    }
}

// Walls that go on side by side do not meet: they part where a step of 50 mm is told from 5 mm of noise,
// which is within a tenth of a beam. One of 10 mm is told to within two.
TEST(Corner, facing_ends_of_a_step_are_known_as_well_as_it_shows)
{
    const double spacing = 2e6 * static_cast<double>(step_nrad) * 1e-9;
    for (const double step : {50e3, 10e3}) {
        const Wall a = wall({-1e6, 2e6}, {0, 2e6}, 1000000000000, 0, 1000000);
        const Wall b = wall({0, 2e6 + step}, {1e6, 2e6 + step}, 1000000000000, 0, 1000000);
        const auto features = found(a.line, b.line);
        const double expected = spacing * spacing * (1.0 / 3 + 26 * std::pow(5e3 / step, 4));
        EXPECT_NEAR(static_cast<double>(features->line[0].var_end_um2), expected, 0.02 * expected) << step;
    }
}

TEST(Corner, lines_far_apart_or_nearly_parallel_make_none)
{
    const Wall right = wall({1e6, -1e6}, {1e6, 1e6}, 1, 0, 1);
    const Wall back = wall({1e6, 1e6}, {-1e6, 1e6}, 1, 0, 1);
    EXPECT_EQ(found(right.line, back.line, 6)->corner_count, 0);
    const Wall short_of_it = wall({1e6, -1e6}, {1e6, 0.8e6}, 1, 0, 1);
    EXPECT_EQ(found(short_of_it.line, back.line)->corner_count, 0);
    const Wall bent = wall({1e6, 1e6}, {1.2e6, 2e6}, 1, 0, 1);
    EXPECT_EQ(found(right.line, bent.line)->corner_count, 0);
}

} // namespace
