/* Mounting, wheels and lag from the pieces of a drive, by least squares.
 *
 * With g = 1 / distance factor, the wheels count of a piece
 *     forward = a m_x - b m_y + lever v          a = g cos theta,  b = g sin theta
 *     left    = b m_x + a m_y - lever u          u = g x,          v = g y
 *     turn    = turn / turn factor + bias * forward
 * which is linear but for the lag. It is what the wheels counted that is explained by what the scans saw, not
 * the other way round: the errors of wheels are the larger ones, and on that side they bias nothing.
 * Source: A. Censi, A. Franchi, L. Marchionni, G. Oriolo, "Simultaneous calibration of odometry and sensor
 * parameters for mobile robots", IEEE T-RO 29(2), 2013; the lag and the outliers are additions. */
#ifndef ALE_ROBOT_CALIBRATE_MOUNTING_FIT_H
#define ALE_ROBOT_CALIBRATE_MOUNTING_FIT_H

#include <array>

#include "robot/calibrate/drive.h"

namespace mounting
{

enum Quantity { X, Y, THETA, LAG, DISTANCE_FACTOR, TURN_FACTOR, TURN_BIAS, QUANTITIES };

struct Estimate {
    double value;
    double sigma;
    bool determined; /* sigma is below what is worth writing into a configuration */
};

struct Fit {
    std::array<Estimate, QUANTITIES> estimate; /* metres, radians, seconds, radians per metre */
    size_t pieces;
    size_t set_aside;  /* slip and wrong matches: they count less than half */
    double way;        /* metres driven, by the scans */
    double turned;     /* radians turned, left and right both counted */
    double way_error;  /* robust sigma of a piece: metres, */
    double turn_error; /* and radians */
};

/* Throws std::runtime_error: the drive is too short, or the wheels turn against the scans. */
Fit fit(const Drive &drive);

} // namespace mounting

#endif
