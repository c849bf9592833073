/* The check of a first drive while it is driven: ALE_POSE and ALE_ODOMETRY as they come. */
#ifndef ALE_ROBOT_CALIBRATE_LIVE_H
#define ALE_ROBOT_CALIBRATE_LIVE_H

#include <string>

namespace calibrate
{

/* Listens until enough was driven, for `seconds` at most or until an interrupt; says on the standard error
 * what is to be driven, prints what was found. True when all is fine. Throws std::runtime_error when LCM
 * cannot be joined, when no robot is heard, or when too little was driven. */
bool check_first_drive(const std::string &lcm_url, int seconds);

} // namespace calibrate

#endif
