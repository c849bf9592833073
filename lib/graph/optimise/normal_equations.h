// The normal equations of a pose graph, summed edge by edge and solved: three unknowns a pose, and one more
// for the building's direction, which all heading priors share.
//
//   NormalEquations equations(poses, edges);
//   equations.clear(true);
//   equations.add(k, linearised, weight);
//   if (equations.solve()) { ... equations.step(pose) ... }
//
// The building's direction is a border of the matrix and not a row of it: it ties
// hundreds of poses, and would fill the factor.
#ifndef ALE_GRAPH_OPTIMISE_NORMAL_EQUATIONS_H
#define ALE_GRAPH_OPTIMISE_NORMAL_EQUATIONS_H

#include <vector>

#include <Eigen/Core>

#include "graph/optimise/block_cholesky.h"
#include "graph/optimise/pose_graph.h"

namespace ale
{

// An edge at the present poses. By increments of (x, y, theta) of its ends the error becomes
// e + to * (increment of `to` - carry * increment of `from`).
struct LinearisedEdge {
    Eigen::Vector3d e;
    Eigen::Matrix3d to;
    Eigen::Matrix3d carry; // turning `from` moves what it sees
};

class NormalEquations
{
  public:
    NormalEquations(size_t poses, const std::vector<GraphEdge> &edges);

    // hold_first: the first pose stays where it is.
    void clear(bool hold_first);
    // Edge k of those that the constructor was given.
    void add(size_t k, const GraphEdge &edge, const LinearisedEdge &linearised, double weight);
    // e: heading of the pose minus what the prior says.
    void add(const HeadingPrior &prior, double e, double weight);
    void add(const PosePull &pull);

    // False: singular.
    bool solve();

    Eigen::Vector3d step(size_t pose) const
    {
        return x_.segment<3>(static_cast<Eigen::Index>(3 * pose));
    }
    double building_step() const
    {
        return building_step_;
    }
    double largest_step() const;

  private:
    void solve_for_building();

    BlockCholesky h_;
    Eigen::VectorXd x_;      // minus the gradient, then the step
    Eigen::VectorXd border_; // column of the building's direction
    double corner_ = 0;      // its own entry of the matrix
    double building_ = 0;    // minus its gradient
    double building_step_ = 0;
};

} // namespace ale

#endif
