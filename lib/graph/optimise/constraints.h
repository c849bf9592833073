// What ties the poses of a graph: the constraints that the optimiser solves for. Poses are numbered from 0;
// residuals and increments are (x, y, theta) in metres and radians, information in 1/m^2, 1/(m rad), 1/rad^2.
#ifndef ALE_GRAPH_OPTIMISE_CONSTRAINTS_H
#define ALE_GRAPH_OPTIMISE_CONSTRAINTS_H

#include <vector>

#include <Eigen/Core>

#include "graph/optimise/se2.h"

namespace ale
{

// How the way between two maps is known, the better first: measured, no guess; told by wheels while no scans
// came; the robot is about where the prediction has put it; it may be anywhere.
enum class Guess { none, led, near, anywhere };

// A relative measurement between two poses: odometry, scan match or loop.
struct GraphEdge {
    int from;
    int to;
    Pose measured;               // `to` as seen from `from`
    Eigen::Matrix3d information; // of the measurement
    bool robust;                 // may be wrong: weighted by the robust kernel
    bool recognised = false;     // not measured: the tracker already lies on what was seen then
    Guess guess = Guess::none;   // between two maps: holds them somewhere, and bends nothing
    bool joins = false;          // a loop between two maps that nothing tied before
    double reach_m = 0;          // of a guess of anywhere: it is no farther off
};

// The heading of a pose against the direction of the building, which all priors share.
struct HeadingPrior {
    int pose;
    double heading_rad; // from the building's direction
    double information; // 1/rad^2
    bool robust = true;
};

// Building-direction constraint: the direction is one more unknown of the graph.
struct BuildingConstraint {
    double direction_rad = 0; // of the building in the map
    std::vector<HeadingPrior> priors;
};

// Where a pose lies in a map from an earlier drive; always under the robust kernel.
struct PosePrior {
    int pose;
    Pose measured;
    Eigen::Matrix3d information; // in the frame of the measured pose
};

// A prior already linearised at the present pose: it holds for one iteration.
struct LinearisedPrior {
    int pose;
    Eigen::Matrix3d information;
    Eigen::Vector3d right_side; // minus the gradient of the cost
};

// Information of independent errors: sigma_m along x and y, sigma_rad of the heading; both above 0.
inline Eigen::Matrix3d information_from_deviations(double sigma_m, double sigma_rad)
{
    return Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
        .asDiagonal();
}

// Of a guess: solvable beside it, and a millionth of what odometry says.
inline Eigen::Matrix3d guess_information()
{
    constexpr double sigma_m = 10;
    constexpr double sigma_rad = 1;
    return information_from_deviations(sigma_m, sigma_rad);
}

// Jacobian of the end of a displacement by its beginning, each in its own frame: the adjoint of the inverse
// of `step`.
inline Eigen::Matrix3d displacement_jacobian(const Pose &step)
{
    const Pose back = inverse(step);
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    a.block<2, 2>(0, 0) = rotation(back.theta);
    a.block<2, 1>(0, 2) << back.y, -back.x;
    return a;
}

} // namespace ale

#endif
