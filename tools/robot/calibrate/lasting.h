/* What stays the same in every scan: the bias of a surface, and walls that look wavy because neighbouring
 * beams share an error.
 *
 * Straight walls are found by libale in the mean of all scans. With the true wall (alpha, rho),
 *     r_i = rho / cos(phi_i - alpha) + bias + error_i,
 * where a bias bends the wall: seen under a wide angle it can be told from distance. The covariance of the
 * errors (of each beam's own, and shared with exp(-lag / length)) follows from the products of the residuals,
 * whose expectation P S P is known for the projector P of the fit; the bias by generalised least squares. */
#ifndef ALE_ROBOT_CALIBRATE_LASTING_H
#define ALE_ROBOT_CALIBRATE_LASTING_H

#include <vector>

#include "robot/calibrate/temporal.h"

namespace calibrate
{

struct Wall {
    int first = 0; /* beams */
    int last = 0;
    double alpha = 0;
    double rho = 0;
    double bias = 0;
    double bias_sigma = 0;
};

struct LastingFit {
    double own = 0; /* m^2 */
    double shared = 0;
    double shared_relative = 0;
    double length = 12;       /* beams */
    double surface = 0;       /* m^2: mean square of the biases of these walls */
    double bias_variance = 0; /* m^2: how well one of them is known */
    std::vector<Wall> walls;
};

/* Without a straight wall all is 0. */
LastingFit fit_lasting(const Recording &recording, const std::vector<Beam> &beams,
                       const TemporalFit &temporal);

} // namespace calibrate

#endif
