// Sparse LDL^T of a symmetric positive definite matrix of 3x3 blocks: one row of blocks a pose, one block off
// the diagonal for each pair of poses with a common constraint.
//
//   BlockCholesky matrix(poses, pairs);
//   matrix.clear();
//   matrix.add_diagonal(0, block);  matrix.add(pair, block);
//   if (matrix.factorise()) {
//       matrix.solve(&x);
//   }
//
// The pattern is ordered once (approximate minimum degree) for any number of factorisations.
// Source: up-looking factorisation after Davis, "Algorithm 849: a concise sparse Cholesky factorization
// package" (2005), with blocks in place of numbers.
#ifndef ALE_GRAPH_OPTIMISE_BLOCK_CHOLESKY_H
#define ALE_GRAPH_OPTIMISE_BLOCK_CHOLESKY_H

#include <utility>
#include <vector>

#include <Eigen/Core>

namespace ale
{

class BlockCholesky
{
  public:
    using Pair = std::pair<int, int>;

    // `rows` rows of blocks. A pair names two different rows, in either order and any number of times. May
    // throw std::bad_alloc, as factorise() and solve() may.
    BlockCholesky(size_t rows, const std::vector<Pair> &pairs);

    // Sets all blocks to zero. O(rows + pairs).
    void clear();
    // Adds to a block of the diagonal. O(1).
    void add_diagonal(int row, const Eigen::Matrix3d &block);
    // Adds to the block in the row of the pair's first and the column of its second; pair: its index. O(1).
    void add(size_t pair, const Eigen::Matrix3d &block);

    // False: not positive definite. Work: blocks() times the length of their columns.
    bool factorise();

    // x: the right side, then the solution; three entries a row. After factorise(). O(blocks()).
    void solve(Eigen::VectorXd *x) const;

    // Blocks of the factor below the diagonal.
    size_t blocks() const
    {
        return row_.size();
    }

  private:
    struct Slot {
        size_t at;
        bool transposed;
    };

    void order(const std::vector<Pair> &pairs);
    void place(const std::vector<Pair> &pairs);
    void find_fill();
    size_t pattern_of(int k);
    void eliminate(int i, int k);

    // Rows and columns below are in the order of elimination. First the blocks above the diagonal.
    std::vector<int> position_; // of a row as the caller counts
    std::vector<Slot> slots_;   // of a pair
    std::vector<size_t> first_; // of column k, in above_row_ and above_
    std::vector<int> above_row_;
    std::vector<Eigen::Matrix3d> above_;
    std::vector<Eigen::Matrix3d> diagonal_;

    // The factor, by columns below the diagonal, and the inverse of its diagonal.
    std::vector<int> parent_;    // in the elimination tree
    std::vector<size_t> column_; // where column i begins, in row_ and below_
    std::vector<size_t> filled_; // up to where it is known
    std::vector<int> row_;
    std::vector<Eigen::Matrix3d> below_;
    std::vector<Eigen::Matrix3d> pivot_;
    std::vector<Eigen::Matrix3d> inverse_;

    // Of the row that is being eliminated.
    std::vector<int> seen_;
    std::vector<int> path_;
    std::vector<int> pattern_;
    std::vector<Eigen::Matrix3d> work_;
};

} // namespace ale

#endif
