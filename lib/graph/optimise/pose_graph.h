// Pose graph: poses tied by relative measurements, solved by damped Gauss-Newton with sparse Cholesky.
//
//   PoseGraph graph;
//   graph.add_pose(first);  graph.add_pose(second);
//   graph.add_edge({0, 1, measured, information, false});
//   graph.optimise(10);
//
// The first pose is held, unless there are anchors. Loop edges carry a robust kernel (dynamic covariance
// scaling, Agarwal et al. 2013): a loop that contradicts the rest loses its weight instead of bending the
// map. Not thread-safe. Work of one iteration: sparse LDL^T of 3n x 3n, n poses.
#ifndef ALE_GRAPH_OPTIMISE_POSE_GRAPH_H
#define ALE_GRAPH_OPTIMISE_POSE_GRAPH_H

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "graph/optimise/se2.h"

namespace ale
{

// A robust edge keeps its full weight up to this Mahalanobis square, then fades.
constexpr double robust_kernel = 10;

struct GraphEdge {
    int from;
    int to;
    Pose measured;               // `to` as seen from `from`
    Eigen::Matrix3d information; // of (x, y, theta) of the measurement; 1/m^2, 1/(m rad), 1/rad^2
    bool robust;
    bool recognised = false; // not measured: the tracker's word that it has been here
};

// A heading against one direction that all of them share and that is an unknown too: the building's.
struct HeadingPrior {
    int pose;
    double theta;       // as seen from the building's direction
    double information; // 1/rad^2
    bool robust = true;
};
struct BuildingHeadings {
    double building = 0; // its direction in the map
    std::vector<HeadingPrior> priors;
};

// Where a pose lies in a map that is known: always under the robust kernel.
struct PoseAnchor {
    int pose;
    Pose measured;
    Eigen::Matrix3d information; // of (x, y, theta), in the pose's own frame
};

// What draws a pose where it is seen to lie, as it stands now: minus the gradient of what its scan misses the
// map by, and the information, by increments of (x, y, theta).
struct PosePull {
    int pose;
    Eigen::Matrix3d information;
    Eigen::Vector3d pull;
};

struct GraphReport {
    int iterations;
    double chi2; // weighted, robust edges scaled
    bool solved; // false: the system could not be factorised; the poses are as they were
};

class NormalEquations;

// Information of what is known to so much, along x and y alike and in the heading.
Eigen::Matrix3d known_to(double sigma_m, double sigma_rad);

// What a displacement of a pose, seen in its own frame, is in the frame of another that `step` leads to.
Eigen::Matrix3d carried_over(const Pose &step);

class PoseGraph
{
  public:
    // Memory for so many, touched, so that adding them takes none.
    void reserve(size_t poses, size_t edges);
    void clear(); // keeps that memory
    int add_pose(const Pose &pose);
    void add_edge(const GraphEdge &edge);
    // In place of all edges.
    void set_edges(std::vector<GraphEdge> edges)
    {
        edges_ = std::move(edges);
    }
    // In place of those before.
    void set_headings(BuildingHeadings headings)
    {
        headings_ = std::move(headings);
    }
    const BuildingHeadings &headings() const
    {
        return headings_;
    }
    // Those before stay.
    void add_anchor(const PoseAnchor &anchor)
    {
        anchors_.push_back(anchor);
    }
    // In place of those before.
    void set_anchors(std::vector<PoseAnchor> anchors)
    {
        anchors_ = std::move(anchors);
    }
    const std::vector<PoseAnchor> &anchors() const
    {
        return anchors_;
    }
    // In place of those before. They hold for one iteration: what pulls must be asked anew at the new poses.
    void set_pulls(std::vector<PosePull> pulls)
    {
        pulls_ = std::move(pulls);
    }
    // A wider kernel lets go of robust edges later: for a graph whose poses are not near the truth yet.
    GraphReport optimise(int max_iterations, double kernel = robust_kernel);

    // Takes pose k out, one that has a pose before and after it; those after it move down by one. The two
    // edges of the way become one, measured through it. Robust edges that end at it end at the pose after
    // it, those that begin at it begin at the pose before it, its anchors and headings go; what would tie two
    // poses twice, or be more than max_robust that end at one pose, falls away. O(poses + edges *
    // max_robust).
    void take_out(int k, int max_robust);

    const std::vector<Pose> &poses() const
    {
        return poses_;
    }
    const std::vector<GraphEdge> &edges() const
    {
        return edges_;
    }

    // Mahalanobis square of an edge's residual at the present poses, not scaled.
    double residual2(const GraphEdge &edge) const;
    double residual2(const PoseAnchor &anchor) const;
    // The same, but no more than the robust kernel.
    double misfit(const GraphEdge &edge) const;
    // What the robust kernel leaves of it there, 0..1.
    double weight(const GraphEdge &edge) const;

  private:
    double linearise(NormalEquations *equations, double kernel) const;
    void move(const NormalEquations &equations);
    bool has_room(const GraphEdge &edge, int max_robust) const;
    std::vector<GraphEdge> cut_loose(int k);
    void renumber_above(int k);

    std::vector<Pose> poses_;
    std::vector<GraphEdge> edges_;
    BuildingHeadings headings_;
    std::vector<PoseAnchor> anchors_;
    std::vector<PosePull> pulls_;
};

} // namespace ale

#endif
