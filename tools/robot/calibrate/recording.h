/* A recording of a scanner as a table: what every beam measured in every scan. */
#ifndef ALE_ROBOT_CALIBRATE_RECORDING_H
#define ALE_ROBOT_CALIBRATE_RECORDING_H

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "base/scan.h"
}

namespace calibrate
{

constexpr int least_scans = 20;
constexpr int most_scans = 5000; /* what follows is not read: more tells nothing new */

/* Metres, radians. range(scan, beam) is not a number where the beam gave no value. */
struct Recording {
    Eigen::MatrixXd range;
    std::vector<double> time_s; /* of each scan */
    double first_bearing = 0;
    double step = 0;
    std::unique_ptr<ale_scan_t> geometry; /* a scan of the recording, for its geometry */

    int scans() const
    {
        return static_cast<int>(range.rows());
    }
    int beams() const
    {
        return static_cast<int>(range.cols());
    }
    double bearing(int beam) const
    {
        return first_bearing + step * beam;
    }
};

/* Throws std::runtime_error, one line that names the file: not readable, fewer than least_scans scans, scans
 * of different geometry. */
Recording read_recording(const std::string &path);

} // namespace calibrate

#endif
