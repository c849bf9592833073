/* Whether what was taken for one straight wall is two that meet at a blunt corner: the extractor is told to
 * be tolerant here, because a sensor that makes walls wavy is to be calibrated too, and then takes bends of a
 * few degrees for waves. Waves go on everywhere; a bend is gone when each side has a wall of its own. */
#ifndef ALE_ROBOT_CALIBRATE_BEND_H
#define ALE_ROBOT_CALIBRATE_BEND_H

#include <Eigen/Core>
#include <optional>

namespace calibrate
{

/* The first row of the second wall, when two fits leave less than a quarter of the squares that one leaves.
 * jacobian: of the measurements by a wall's three parameters; residual: what their fit leaves. Either side
 * gets at least `least` rows. One pass over the rows. */
std::optional<Eigen::Index> bend_of(const Eigen::MatrixXd &jacobian, const Eigen::VectorXd &residual,
                                    Eigen::Index least);

} // namespace calibrate

#endif
