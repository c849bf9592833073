// The normal equations of a pose graph, summed constraint by constraint and solved: three unknowns a pose,
// and one more for the building's direction, which all heading priors share.
//
//   NormalEquations equations(poses, edges);
//   equations.clear(true);
//   equations.add(k, edge, linearised, weight);
//   if (equations.solve()) { ... equations.step(pose) ... }
//
// The building's direction is a border of the matrix (Schur complement): as a row it would tie hundreds of
// poses and fill the factor.
#ifndef ALE_GRAPH_OPTIMISE_NORMAL_EQUATIONS_H
#define ALE_GRAPH_OPTIMISE_NORMAL_EQUATIONS_H

#include <vector>

#include <Eigen/Core>

#include "graph/optimise/block_cholesky.h"
#include "graph/optimise/constraints.h"

namespace ale
{

// An edge at the present poses. By increments of (x, y, theta) of its ends the residual becomes
// residual + jacobian * (increment of `to` - transfer * increment of `from`).
struct LinearisedEdge {
    Eigen::Vector3d residual;
    Eigen::Matrix3d jacobian;
    Eigen::Matrix3d transfer; // turning `from` moves what it sees
};

class NormalEquations
{
  public:
    // For so many poses and these edges, in their order. May throw std::bad_alloc, as no other but solve().
    NormalEquations(size_t poses, const std::vector<GraphEdge> &edges);

    // Sets all sums to zero. hold_first: the first pose stays where it is. O(poses + edges).
    void clear(bool hold_first);
    // This pose stays where it is. O(1).
    void hold(size_t pose);
    // Adds edge k of the constructor's. O(1).
    void add(size_t k, const GraphEdge &edge, const LinearisedEdge &linearised, double weight);
    // residual_rad: heading of the pose minus the prior's. O(1).
    void add(const HeadingPrior &prior, double residual_rad, double weight);
    void add(const LinearisedPrior &prior);

    // False: not positive definite; the steps are undefined. Time: one or two solutions by BlockCholesky.
    bool solve();

    // The increment of a pose; metres, radians.
    Eigen::Vector3d step(size_t pose) const
    {
        return x_.segment<3>(static_cast<Eigen::Index>(3 * pose));
    }
    // The increment of the building's direction, radians.
    double building_step() const
    {
        return building_step_;
    }
    // Largest magnitude of all increments.
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
