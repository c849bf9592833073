// lib/base/noise.c: paper (1) to (7) and (26) in normal form, against double and against drawn points.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>

extern "C" {
#include "base/noise.h"
#include "base/trig.h"
}

namespace
{

constexpr double pi = 3.14159265358979323846;

uint32_t bam(double radians)
{
    return static_cast<uint32_t>(static_cast<int64_t>(std::llround(radians / (2 * pi) * 4294967296.0)));
}

ale_noise_t some_noise()
{
    ale_noise_t noise = ale_noise_default();
    noise.own_um = 3000;
    noise.own_ppm = 7000;
    noise.bearing_nrad = 2000000;
    return noise;
}

TEST(Noise, VarianceHasAConstantAndAProportionalPart)
{
    const ale_noise_t noise = some_noise();
    EXPECT_EQ(ale_noise_own_var_um2(&noise, 0), 9000000);
    EXPECT_NEAR(static_cast<double>(ale_noise_own_var_um2(&noise, 4000000)), 9e6 + 28e3 * 28e3, 1.0);
    const ale_noise_t standard = ale_noise_default();
    EXPECT_NEAR(static_cast<double>(ale_noise_shared_var_um2(&standard, 3000000)),
                std::pow(standard.shared_um, 2) + std::pow(standard.shared_ppm * 3.0, 2), 1.0);
}

TEST(Noise, CovarianceOfAPointIsEquationSeven)
{
    const ale_noise_t noise = some_noise();
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> angle(-pi, pi);
    std::uniform_int_distribution<int32_t> range(20000, 80000000);
    for (int k = 0; k < 20000; k++) {
        const double phi = angle(engine);
        const int32_t d = range(engine);
        int64_t cov[3];
        ale_noise_point_cov(&noise, d, bam(phi), cov);
        const double sd2 = 9e6 + std::pow(0.007 * d, 2);
        const double sp2 = std::pow(0.002 * d, 2);
        const double xx = sd2 * std::pow(std::cos(phi), 2) + sp2 * std::pow(std::sin(phi), 2);
        const double yy = sd2 * std::pow(std::sin(phi), 2) + sp2 * std::pow(std::cos(phi), 2);
        const double xy = (sd2 - sp2) * std::sin(phi) * std::cos(phi);
        const double bound =
            std::sqrt(sd2) + std::sqrt(sp2) + 1e-8 * (sd2 + sp2) + 2; // deviations are whole um
        EXPECT_NEAR(static_cast<double>(cov[0]), xx, bound);
        EXPECT_NEAR(static_cast<double>(cov[1]), xy, bound);
        EXPECT_NEAR(static_cast<double>(cov[2]), yy, bound);
    }
}

TEST(Noise, VarianceAlongTheNormalIsWhatDrawnPointsShow)
{
    const ale_noise_t noise = some_noise();
    std::mt19937 engine(2);
    std::normal_distribution<double> gauss;
    for (const double incidence : {0.0, 0.5, 1.0, 1.3}) {
        const double alpha = 0.4;
        const double phi = alpha + incidence;
        const double d = 2.5e6;
        double sum = 0;
        const int draws = 200000;
        for (int k = 0; k < draws; k++) {
            const double r = d + std::sqrt(9e6 + std::pow(0.007 * d, 2)) * gauss(engine);
            const double b = phi + 0.002 * gauss(engine);
            sum += std::pow(r * std::cos(b - alpha) - d * std::cos(incidence), 2);
        }
        const double got = static_cast<double>(
            ale_noise_normal_var_um2(&noise, static_cast<int32_t>(d), bam(phi), bam(alpha)));
        EXPECT_NEAR(got / (sum / draws), 1.0, 0.015) << incidence;
    }
}

} // namespace
