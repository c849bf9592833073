#include "robot/calibrate/bend.h"

#include <Eigen/Cholesky>

namespace calibrate
{

namespace
{

constexpr double telling = 4; /* times fewer squares: waves that are shared by neighbours make about 1.5 */

/* Normal equations of a run of rows; runs can be added and taken off. */
struct Sums {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double squares = 0;

    void add(const Eigen::RowVector3d &row, double residual, double sign)
    {
        information += sign * row.transpose() * row;
        gradient += sign * residual * row.transpose();
        squares += sign * residual * residual;
    }
    /* Squares that a fit of its own leaves; a little ridge, for bias and distance are hardly told apart. */
    double left() const
    {
        const Eigen::Matrix3d ridge = 1e-9 * information.trace() * Eigen::Matrix3d::Identity();
        return squares - gradient.dot((information + ridge).ldlt().solve(gradient));
    }
};

} // namespace

std::optional<Eigen::Index> bend_of(const Eigen::MatrixXd &jacobian, const Eigen::VectorXd &residual,
                                    Eigen::Index least)
{
    Sums before;
    Sums after;
    for (Eigen::Index k = 0; k < residual.size(); k++) {
        after.add(jacobian.row(k), residual(k), 1);
    }
    const double one = after.left();
    double two = one;
    Eigen::Index at = 0;
    for (Eigen::Index k = 0; k + least < residual.size(); k++) {
        before.add(jacobian.row(k), residual(k), 1);
        after.add(jacobian.row(k), residual(k), -1);
        if (k + 1 >= least && before.left() + after.left() < two) {
            two = before.left() + after.left();
            at = k + 1;
        }
    }
    return two * telling < one ? std::optional(at) : std::nullopt;
}

} // namespace calibrate
