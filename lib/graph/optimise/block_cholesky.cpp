#include "graph/optimise/block_cholesky.h"

#include <algorithm>

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>

namespace ale
{

namespace
{

// By leading minors.
bool is_positive(const Eigen::Matrix3d &m)
{
    return m(0, 0) > 0 && m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0) > 0 && m.determinant() > 0;
}

} // namespace

BlockCholesky::BlockCholesky(size_t rows, const std::vector<Pair> &pairs)
    : position_(rows), diagonal_(rows), parent_(rows, -1), pivot_(rows), inverse_(rows), seen_(rows, -1),
      path_(rows), pattern_(rows), work_(rows, Eigen::Matrix3d::Zero())
{
    order(pairs);
    place(pairs);
    find_fill();
}

void BlockCholesky::order(const std::vector<Pair> &pairs)
{
    std::vector<Eigen::Triplet<char, int>> entries;
    entries.reserve(position_.size() + pairs.size());
    for (int k = 0; k < static_cast<int>(position_.size()); k++) {
        entries.emplace_back(k, k, 1); // without it Eigen takes the row for dense and puts it last
    }
    for (const Pair &pair : pairs) {
        entries.emplace_back(std::min(pair.first, pair.second), std::max(pair.first, pair.second), 1);
    }
    const auto rows = static_cast<Eigen::Index>(position_.size());
    Eigen::SparseMatrix<char, Eigen::ColMajor, int> pattern(rows, rows);
    pattern.setFromTriplets(entries.begin(), entries.end(), [](char a, char) { return a; });
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> eliminated;
    Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Upper>(), eliminated);
    for (int k = 0; k < static_cast<int>(rows); k++) {
        position_[static_cast<size_t>(eliminated.indices()(k))] = k;
    }
}

// Columns of the upper half; repeated pairs share one block.
void BlockCholesky::place(const std::vector<Pair> &pairs)
{
    struct Entry {
        int column;
        int row;
        size_t pair;
    };
    std::vector<Entry> entries;
    entries.reserve(pairs.size());
    slots_.resize(pairs.size());
    for (size_t k = 0; k < pairs.size(); k++) {
        const int a = position_[static_cast<size_t>(pairs[k].first)];
        const int b = position_[static_cast<size_t>(pairs[k].second)];
        slots_[k].transposed = a > b;
        entries.push_back({std::max(a, b), std::min(a, b), k});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
        return a.column != b.column ? a.column < b.column
                                    : (a.row != b.row ? a.row < b.row : a.pair < b.pair);
    });
    first_.assign(position_.size() + 1, 0);
    for (size_t k = 0; k < entries.size(); k++) {
        const bool again =
            k > 0 && entries[k].column == entries[k - 1].column && entries[k].row == entries[k - 1].row;
        if (!again) {
            above_row_.push_back(entries[k].row);
            first_[static_cast<size_t>(entries[k].column) + 1]++;
        }
        slots_[entries[k].pair].at = above_row_.size() - 1;
    }
    for (size_t k = 1; k < first_.size(); k++) {
        first_[k] += first_[k - 1];
    }
    above_.resize(above_row_.size());
}

// Elimination tree and the lengths of the columns of the factor.
void BlockCholesky::find_fill()
{
    const int rows = static_cast<int>(position_.size());
    column_.assign(position_.size() + 1, 0);
    for (int k = 0; k < rows; k++) {
        const auto column = static_cast<size_t>(k);
        seen_[column] = k;
        for (size_t p = first_[column]; p < first_[column + 1]; p++) {
            for (auto i = static_cast<size_t>(above_row_[p]); seen_[i] != k;
                 i = static_cast<size_t>(parent_[i])) {
                parent_[i] = parent_[i] < 0 ? k : parent_[i];
                column_[i + 1]++;
                seen_[i] = k;
            }
        }
    }
    for (size_t k = 1; k < column_.size(); k++) {
        column_[k] += column_[k - 1];
    }
    row_.resize(column_.back());
    below_.resize(column_.back());
}

void BlockCholesky::clear()
{
    std::fill(above_.begin(), above_.end(), Eigen::Matrix3d::Zero());
    std::fill(diagonal_.begin(), diagonal_.end(), Eigen::Matrix3d::Zero());
}

void BlockCholesky::add_diagonal(int row, const Eigen::Matrix3d &block)
{
    diagonal_[static_cast<size_t>(position_[static_cast<size_t>(row)])] += block;
}

void BlockCholesky::add(size_t pair, const Eigen::Matrix3d &block)
{
    const Slot slot = slots_[pair];
    if (slot.transposed) {
        above_[slot.at] += block.transpose();
    } else {
        above_[slot.at] += block;
    }
}

// Blocks of row k of the factor that are not zero, in an order in which they can be computed: at the end of
// pattern_, from the index returned. Copies the blocks of the matrix to work_.
size_t BlockCholesky::pattern_of(int k)
{
    const auto column = static_cast<size_t>(k);
    size_t top = pattern_.size();
    seen_[column] = k;
    for (size_t p = first_[column]; p < first_[column + 1]; p++) {
        work_[static_cast<size_t>(above_row_[p])] = above_[p];
        size_t length = 0;
        for (int i = above_row_[p]; seen_[static_cast<size_t>(i)] != k; i = parent_[static_cast<size_t>(i)]) {
            path_[length++] = i;
            seen_[static_cast<size_t>(i)] = k;
        }
        while (length > 0) {
            pattern_[--top] = path_[--length];
        }
    }
    return top;
}

// Computes block (k, i) of the factor and subtracts its part from the blocks right of it.
void BlockCholesky::eliminate(int i, int k)
{
    const auto column = static_cast<size_t>(i);
    const Eigen::Matrix3d y = work_[column];
    work_[column].setZero();
    for (size_t p = column_[column]; p < filled_[column]; p++) {
        work_[static_cast<size_t>(row_[p])].noalias() -= below_[p] * y;
    }
    const Eigen::Matrix3d scaled = inverse_[column] * y;
    pivot_[static_cast<size_t>(k)].noalias() -= scaled.transpose() * y;
    row_[filled_[column]] = k;
    below_[filled_[column]] = scaled.transpose();
    filled_[column]++;
}

bool BlockCholesky::factorise()
{
    std::fill(seen_.begin(), seen_.end(), -1);
    std::fill(work_.begin(), work_.end(), Eigen::Matrix3d::Zero());
    filled_.assign(column_.begin(), column_.end() - 1);
    pivot_ = diagonal_;
    for (int k = 0; k < static_cast<int>(pivot_.size()); k++) {
        for (size_t at = pattern_of(k); at < pattern_.size(); at++) {
            eliminate(pattern_[at], k);
        }
        const Eigen::Matrix3d &pivot = pivot_[static_cast<size_t>(k)];
        if (!is_positive(pivot)) {
            return false;
        }
        inverse_[static_cast<size_t>(k)] = pivot.inverse();
    }
    return true;
}

void BlockCholesky::solve(Eigen::VectorXd *x) const
{
    const size_t rows = position_.size();
    std::vector<Eigen::Vector3d> y(rows);
    for (size_t k = 0; k < rows; k++) {
        y[static_cast<size_t>(position_[k])] = x->segment<3>(static_cast<Eigen::Index>(3 * k));
    }
    for (size_t i = 0; i < rows; i++) {
        for (size_t p = column_[i]; p < column_[i + 1]; p++) {
            y[static_cast<size_t>(row_[p])] -= below_[p] * y[i];
        }
    }
    for (size_t i = rows; i-- > 0;) {
        Eigen::Vector3d sum = inverse_[i] * y[i];
        for (size_t p = column_[i]; p < column_[i + 1]; p++) {
            sum -= below_[p].transpose() * y[static_cast<size_t>(row_[p])];
        }
        y[i] = sum;
    }
    for (size_t k = 0; k < rows; k++) {
        x->segment<3>(static_cast<Eigen::Index>(3 * k)) = y[static_cast<size_t>(position_[k])];
    }
}

} // namespace ale
