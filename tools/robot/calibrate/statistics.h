/* Robust location and scale of values, some of which may be missing. */
#ifndef ALE_ROBOT_CALIBRATE_STATISTICS_H
#define ALE_ROBOT_CALIBRATE_STATISTICS_H

#include <Eigen/Core>

namespace calibrate
{

struct Spread {
    int count = 0; /* values there are */
    double median = 0;
    double sigma = 0; /* 1.4826 median absolute deviations */
};

/* Values that are not numbers are left out. */
Spread robust_spread(const Eigen::Ref<const Eigen::VectorXd> &values);

/* Least squares of a x = b with no x below 0: the best over all subsets of the columns, of which there are
 * few (at most 6). Rows are to be weighted already. */
Eigen::VectorXd non_negative_solution(const Eigen::MatrixXd &a, const Eigen::VectorXd &b);

/* The place of the least value of a function with one minimum, by golden sections. */
template <typename Function> double least_place(double low, double high, int steps, const Function &function)
{
    constexpr double golden = 0.6180339887498949;
    double a = high - golden * (high - low);
    double b = low + golden * (high - low);
    double at_a = function(a);
    double at_b = function(b);
    for (int k = 0; k < steps; k++) {
        if (at_a < at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = function(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = function(b);
        }
    }
    return (low + high) / 2;
}

} // namespace calibrate

#endif
