// lib/graph/optimise/block_cholesky: against Eigen's dense factorisation.
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "graph/optimise/block_cholesky.h"

namespace
{

using ale::BlockCholesky;

// A path with loops; pairs in both directions and twice.
std::vector<BlockCholesky::Pair> path_with_loops(int rows, std::mt19937 *random)
{
    std::vector<BlockCholesky::Pair> pairs;
    for (int k = 1; k < rows; k++) {
        pairs.emplace_back(k - 1, k);
    }
    std::uniform_int_distribution<int> any(0, rows - 1);
    for (int k = 0; k < rows; k++) {
        const BlockCholesky::Pair pair(any(*random), any(*random));
        if (pair.first != pair.second) {
            pairs.push_back(pair);
        }
    }
    pairs.push_back(pairs.back());
    return pairs;
}

struct System {
    BlockCholesky sparse;
    Eigen::MatrixXd dense;
};

// Sum of J^T J over the pairs, as a pose graph's.
System system_of(int rows, const std::vector<BlockCholesky::Pair> &pairs, std::mt19937 *random)
{
    std::normal_distribution<double> normal(0, 1);
    System system{BlockCholesky(static_cast<size_t>(rows), pairs), Eigen::MatrixXd::Zero(3 * rows, 3 * rows)};
    system.sparse.clear();
    for (int k = 0; k < rows; k++) {
        system.sparse.add_diagonal(k, 0.1 * Eigen::Matrix3d::Identity());
        system.dense.block<3, 3>(3 * k, 3 * k) += 0.1 * Eigen::Matrix3d::Identity();
    }
    for (size_t k = 0; k < pairs.size(); k++) {
        const auto [a, b] = pairs[k];
        const Eigen::Matrix3d ja = Eigen::Matrix3d::NullaryExpr([&] { return normal(*random); });
        const Eigen::Matrix3d jb = Eigen::Matrix3d::NullaryExpr([&] { return normal(*random); });
        system.sparse.add_diagonal(a, ja.transpose() * ja);
        system.sparse.add_diagonal(b, jb.transpose() * jb);
        system.sparse.add(k, ja.transpose() * jb);
        system.dense.block<3, 3>(3 * a, 3 * a) += ja.transpose() * ja;
        system.dense.block<3, 3>(3 * b, 3 * b) += jb.transpose() * jb;
        system.dense.block<3, 3>(3 * a, 3 * b) += ja.transpose() * jb;
        system.dense.block<3, 3>(3 * b, 3 * a) += jb.transpose() * ja;
    }
    return system;
}

TEST(BlockCholesky, SolvesAsADenseFactorisationDoes)
{
    std::mt19937 random(7);
    for (const int rows : {2, 5, 40}) {
        System system = system_of(rows, path_with_loops(rows, &random), &random);
        const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(3 * rows, -1, 2);
        ASSERT_TRUE(system.sparse.factorise());
        Eigen::VectorXd x = right;
        system.sparse.solve(&x);
        EXPECT_LT((x - system.dense.ldlt().solve(right)).norm(), 1e-9 * x.norm()) << rows << " rows";
    }
}

TEST(BlockCholesky, FactorisesAgainWithOtherNumbers)
{
    std::mt19937 random(8);
    const std::vector<BlockCholesky::Pair> pairs = path_with_loops(20, &random);
    System system = system_of(20, pairs, &random);
    ASSERT_TRUE(system.sparse.factorise());
    for (int k = 0; k < 20; k++) {
        system.sparse.add_diagonal(k, Eigen::Matrix3d::Identity());
    }
    system.dense += Eigen::MatrixXd::Identity(60, 60);
    ASSERT_TRUE(system.sparse.factorise());
    Eigen::VectorXd x = Eigen::VectorXd::Ones(60);
    system.sparse.solve(&x);
    EXPECT_LT((system.dense * x - Eigen::VectorXd::Ones(60)).norm(), 1e-9);
}

TEST(BlockCholesky, APathWithoutLoopsHasNoFill)
{
    std::vector<BlockCholesky::Pair> pairs;
    for (int k = 1; k < 500; k++) {
        pairs.emplace_back(k - 1, k);
    }
    EXPECT_EQ(BlockCholesky(500, pairs).blocks(), 499U);
}

TEST(BlockCholesky, RefusesAMatrixThatIsNotPositiveDefinite)
{
    BlockCholesky matrix(2, {{0, 1}});
    matrix.clear();
    matrix.add_diagonal(0, Eigen::Matrix3d::Identity());
    matrix.add_diagonal(1, Eigen::Matrix3d::Identity());
    matrix.add(0, 2 * Eigen::Matrix3d::Identity());
    EXPECT_FALSE(matrix.factorise());
}

} // namespace
