/* What was found, as configuration for ale-slamd with the certainty beside each value. What the drive did not
 * determine stands there as a comment that says which way of driving would. */
#ifndef ALE_ROBOT_CALIBRATE_MOUNTING_REPORT_H
#define ALE_ROBOT_CALIBRATE_MOUNTING_REPORT_H

#include <string>

#include "robot/calibrate/mounting_fit.h"

namespace mounting
{

enum class Part { mounting, wheels, both }; /* section [sensor], section [odometry] */

/* source: name of the log, for the comment at its head. */
std::string configuration(const Fit &fit, const std::string &source, Part part);

} // namespace mounting

#endif
