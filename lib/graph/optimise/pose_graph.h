// Pose graph: poses tied by constraints, solved by damped Gauss-Newton with sparse Cholesky.
//
//   PoseGraph graph;
//   graph.add_pose(first);  graph.add_pose(second);
//   graph.add_edge({0, 1, measured, information, false});
//   graph.optimise(10);
//
// The first pose is held, unless there are pose priors. Robust edges and priors are weighted by dynamic
// covariance scaling (Agarwal et al., ICRA 2013): one that contradicts the rest loses its weight instead of
// bending the map. Metres and radians. Not thread-safe. Whatever adds or optimises may throw std::bad_alloc.
#ifndef ALE_GRAPH_OPTIMISE_POSE_GRAPH_H
#define ALE_GRAPH_OPTIMISE_POSE_GRAPH_H

#include <utility>
#include <vector>

#include "graph/optimise/constraints.h"

namespace ale
{

// A robust constraint keeps its full weight up to this squared Mahalanobis distance, then fades.
constexpr double robust_kernel = 10;

struct GraphReport {
    int iterations;
    double chi2; // sum of all squared residuals before the last step, robust ones weighted
    bool solved; // false: the system could not be factorised; the poses are as before that iteration
};

class NormalEquations;

class PoseGraph
{
  public:
    // Allocates and touches memory for so many, so that adding them allocates nothing. Clears the graph.
    void reserve(size_t poses, size_t edges);
    // Removes all poses and constraints; keeps the memory.
    void clear();

    // Appends a pose, map frame; its number. O(1).
    int add_pose(const Pose &pose);
    // Appends an edge between poses that exist. O(1).
    void add_edge(const GraphEdge &edge);
    // Replaces all edges.
    void set_edges(std::vector<GraphEdge> edges)
    {
        edges_ = std::move(edges);
    }
    // Replaces the building-direction constraint; without priors it has no effect.
    void set_building_constraint(BuildingConstraint building)
    {
        building_ = std::move(building);
    }
    const BuildingConstraint &building_constraint() const
    {
        return building_;
    }
    // Appends a pose prior.
    void add_pose_prior(const PosePrior &prior)
    {
        pose_priors_.push_back(prior);
    }
    // Replaces all pose priors.
    void set_pose_priors(std::vector<PosePrior> priors)
    {
        pose_priors_ = std::move(priors);
    }
    const std::vector<PosePrior> &pose_priors() const
    {
        return pose_priors_;
    }
    // Replaces all linearised priors; they must be computed again after each iteration.
    void set_linearised_priors(std::vector<LinearisedPrior> priors)
    {
        linearised_priors_ = std::move(priors);
    }

    // Poses that optimise() leaves where they are, beside the first; one flag for each, or none at all.
    void hold(std::vector<bool> held)
    {
        held_ = std::move(held);
    }
    // Moves the flagged poses as one; guesses then say what holds now. The building constraint is dropped: it
    // refers to the poses as they were. O(poses + edges).
    void move_rigidly(const std::vector<bool> &moved, const Pose &shift);

    // Gauss-Newton until the largest step is below 1e-6 or max_iterations are done. A kernel wider than
    // robust_kernel suits poses far from the solution. One iteration: sparse LDL^T of 3n x 3n, n poses.
    GraphReport optimise(int max_iterations, double kernel = robust_kernel);

    // Removes pose k, which is neither the first nor the last; later poses move down by one. Its two odometry
    // edges become one. A robust edge that ends at k ends at the next pose, one that begins at k begins at
    // the one before. It is dropped if it repeats an edge, if max_robust already end at its pose, or if that
    // is in another map (a guess lies between). Priors of k go. O(poses + edges * max_robust).
    void remove_pose(int k, int max_robust);

    const std::vector<Pose> &poses() const
    {
        return poses_;
    }
    const std::vector<GraphEdge> &edges() const
    {
        return edges_;
    }

    // Squared Mahalanobis distance of a constraint at the present poses, unweighted. O(1).
    double residual2(const GraphEdge &edge) const;
    double residual2(const PosePrior &prior) const;
    // residual2, at most robust_kernel.
    double misfit(const GraphEdge &edge) const;
    // What optimise() descends on: squared residuals of all constraints but linearised priors, at the present
    // poses. A robust one adds ever less above robust_kernel, at most three times that. Of two solutions the
    // likelier has less. O(edges + priors).
    double cost() const;
    // Weight of an edge at the present poses, 0..1; 1 unless robust.
    double weight(const GraphEdge &edge) const;

  private:
    double linearise(NormalEquations *equations, double kernel) const;
    void move(const NormalEquations &equations);
    bool has_room(const GraphEdge &edge, int max_robust) const;
    std::vector<GraphEdge> remove_edges_of(int k);
    void renumber_above(int k);

    std::vector<Pose> poses_;
    std::vector<GraphEdge> edges_;
    BuildingConstraint building_;
    std::vector<PosePrior> pose_priors_;
    std::vector<LinearisedPrior> linearised_priors_;
    std::vector<bool> held_;
};

} // namespace ale

#endif
