/* What is printed is configuration that ale-slamd takes, whatever was found and however the log is called. */
#ifndef ALE_ROBOT_CALIBRATE_CONFIGURATION_H
#define ALE_ROBOT_CALIBRATE_CONFIGURATION_H

#include <string>

namespace calibrate
{

/* The name of a log for a comment: without its folder, printable, not too long for the reader of
 * configurations. */
std::string name_of_log(const std::string &path);

/* Hands the text on. Throws std::runtime_error that names the value which ale-slamd would refuse. */
std::string accepted(const std::string &configuration);

} // namespace calibrate

#endif
