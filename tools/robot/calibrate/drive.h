/* A recorded drive as the calibration sees it: where the laser was, by its scans alone, and what the wheels
 * counted meanwhile. The scans are followed by the firmware's own tracker, told nothing of wheels and
 * mounting, so that its poses are those of the laser; seconds, metres, radians. */
#ifndef ALE_ROBOT_CALIBRATE_DRIVE_H
#define ALE_ROBOT_CALIBRATE_DRIVE_H

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace mounting
{

/* x, y, heading; the heading is not wrapped: it goes on over whole turns. */
using Pose = Eigen::Vector3d;

struct LaserPose {
    double time;
    Pose pose;
    Pose velocity; /* in the frame of the pose */
    bool good;     /* found in the map, not predicted and not in doubt */
};

struct WheelPose {
    double time; /* as stamped */
    Pose pose;
};

class Laser
{
  public:
    explicit Laser(std::vector<LaserPose> poses) : poses_(std::move(poses))
    {
    }
    /* Between two good scans: cubic through poses and velocities. Nothing where the way is not known. */
    std::optional<Pose> at(double time) const;
    /* Median time between scans. */
    double period() const;
    const std::vector<LaserPose> &poses() const
    {
        return poses_;
    }

  private:
    std::vector<LaserPose> poses_;
};

struct Drive {
    Laser laser;
    std::vector<WheelPose> wheels;
    double lag; /* first guess, from turns as the firmware learns it */
    double most_speed;
    double most_turn_rate;
};

/* Throws std::runtime_error with one line that names the file: not readable, no odometry, too few scans;
 * cli::WrongUse for a bad configuration. config: file for ale-slamd, or empty. */
Drive read_drive(const std::string &log, const std::string &config);

} // namespace mounting

#endif
