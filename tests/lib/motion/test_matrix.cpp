// lib/motion/matrix.c against Eigen's LDLT in double.
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

extern "C" {
#include "motion/matrix.h"
}

namespace
{
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// A random positive matrix whose states have scales from 10^2 to 10^6.
Matrix6 random_positive(std::mt19937 &rng)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> decade(2, 6);
    Matrix6 b;
    for (int i = 0; i < 36; i++) {
        b.data()[i] = normal(rng);
    }
    Matrix6 scale = Matrix6::Zero();
    for (int i = 0; i < 6; i++) {
        scale(i, i) = std::pow(10, decade(rng));
    }
    return scale * (b * b.transpose() + 0.3 * Matrix6::Identity()) * scale;
}

ale_matrix_t rounded(const Matrix6 &m)
{
    ale_matrix_t out;
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            out.m[i][j] = std::llround(m(i, j));
        }
    }
    return out;
}

Matrix6 widened(const ale_matrix_t &m)
{
    Matrix6 out;
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            out(i, j) = static_cast<double>(m.m[i][j]);
        }
    }
    return out;
}
} // namespace

TEST(Matrix, SolvesAsEigenDoesWhateverTheScales)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> value(-1e9, 1e9);
    double worst = 0;
    for (int n = 0; n < 2000; n++) {
        const ale_matrix_t a = rounded(random_positive(rng));
        int64_t b[6];
        Vector6 rhs;
        for (int i = 0; i < 6; i++) {
            b[i] = std::llround(value(rng));
            rhs[i] = static_cast<double>(b[i]);
        }
        ale_factors_t factors;
        ASSERT_EQ(ale_matrix_factor(&a, &factors), 0u);
        int64_t x[6];
        ale_matrix_solve(&factors, b, 30, x);
        const Vector6 truth = widened(a).ldlt().solve(rhs);
        // in the unit of each state, relative to the largest
        const Vector6 unit = widened(a).diagonal().cwiseSqrt();
        const double largest = truth.cwiseProduct(unit).cwiseAbs().maxCoeff();
        for (int i = 0; i < 6; i++) {
            const double got = std::ldexp(static_cast<double>(x[i]), -30);
            worst = std::max(worst, (std::abs(got - truth[i]) - std::ldexp(1.0, -30)) * unit[i] / largest);
        }
    }
    EXPECT_LT(worst, 1e-6);
}

TEST(Matrix, InverseTimesMatrixIsOne)
{
    std::mt19937 rng(2);
    for (int n = 0; n < 500; n++) {
        const ale_matrix_t cov = rounded(random_positive(rng));
        ale_factors_t factors;
        ale_matrix_t information;
        ale_matrix_factor(&cov, &factors);
        ale_matrix_invert(&factors, 54, &information);
        const Matrix6 scale = widened(cov).diagonal().cwiseSqrt().asDiagonal();
        const Matrix6 one =
            scale.inverse() * widened(cov) * widened(information) * scale * std::ldexp(1.0, -54);
        EXPECT_LT((one - Matrix6::Identity()).cwiseAbs().maxCoeff(), 2e-2);
        EXPECT_EQ(information.m[1][4], information.m[4][1]);
    }
}

TEST(Matrix, ADirectionThatNothingDeterminesIsCountedAndDoesNotSpoilTheOthers)
{
    ale_matrix_t a = {};
    for (int i = 0; i < 6; i++) {
        a.m[i][i] = int64_t{1} << 40;
    }
    a.m[1][0] = a.m[0][1] = a.m[0][0];
    ale_factors_t factors;
    EXPECT_EQ(ale_matrix_factor(&a, &factors), 1u);
    const int64_t b[6] = {0, 0, int64_t{1} << 40, 0, 0, 0};
    int64_t x[6];
    ale_matrix_solve(&factors, b, 20, x);
    EXPECT_NEAR(static_cast<double>(x[2]), 1 << 20, 1);
}

TEST(Matrix, CongruenceIsThatOfEigen)
{
    std::mt19937 rng(3);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 200; n++) {
        const ale_matrix_t p = rounded(random_positive(rng));
        int64_t f[6][6];
        Matrix6 ff;
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                f[i][j] = std::llround(normal(rng) * (1 << 20));
                ff(i, j) = static_cast<double>(f[i][j]) / (1 << 20);
            }
        }
        ale_matrix_t out;
        ale_matrix_congruence(f, &p, &out);
        const Matrix6 truth = ff * widened(p) * ff.transpose();
        EXPECT_LT((widened(out) - truth).cwiseAbs().maxCoeff(), 1e-9 * truth.cwiseAbs().maxCoeff() + 40);
    }
}
