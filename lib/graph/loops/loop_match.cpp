#include "graph/loops/loop_match.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

namespace ale
{

namespace
{

constexpr size_t coarse_points = 32; // score all hypotheses, to choose those that are scored with more
constexpr size_t scored_points = 120;
constexpr size_t scored_hypotheses = 600;
constexpr size_t max_corner_hypotheses = 2000;
constexpr int window_step_cells = 2;
constexpr double window_step_m = window_step_cells * LikelihoodField::cell_m;
constexpr double window_step_rad = 0.035;
constexpr double distinct_m = 0.40; // poses farther apart are different places
constexpr double distinct_rad = 0.26;
constexpr size_t refined_hypotheses = 6;
constexpr double corner_angle_tolerance_rad = 0.30;
constexpr double inlier_m = 0.06;

struct Hypothesis {
    Pose pose;
    double score;
};

// Which points make a pair.
struct Pairing {
    double least_cosine; // between their normals
    bool normals_needed; // both points must have one
    double damping;      // of a step, as if so many pairs held each direction where it is
};
constexpr Pairing loose{0.5, false, 1e-3};
constexpr Pairing strict{0.8, true, 0.05};

struct Pass {
    int count;
    double gate_m;
};
constexpr Pass coarse_to_fine[] = {{4, 0.25}, {4, 0.12}, {4, 0.06}};
constexpr Pass fine_passes[] = {{1, 0.20}, {1, 0.15}, {2, 0.10}, {4, 0.06}};

bool is_inside(const Pose &pose, const Pose &guess, const SearchWindow &window)
{
    return length(pose.x - guess.x, pose.y - guess.y) <= window.half_m &&
           std::abs(wrapped(pose.theta - guess.theta)) <= window.half_rad;
}

// Section IV of the paper: a pair of corners gives the translation, their bisectors the rotation.
void hypotheses_from_corners(const std::vector<CornerFeature> &corners,
                             const std::vector<CornerFeature> &field_corners, const Pose &guess,
                             const SearchWindow &window, std::vector<Pose> *out)
{
    for (const CornerFeature &here : corners) {
        for (const CornerFeature &there : field_corners) {
            if (here.convex != there.convex ||
                std::abs(here.angle_rad - there.angle_rad) > corner_angle_tolerance_rad) {
                continue;
            }
            const double theta = wrapped(there.bisector_rad - here.bisector_rad);
            const Eigen::Vector2d p = there.p - rotation(theta) * here.p;
            const Pose pose{p.x(), p.y(), theta};
            if (is_inside(pose, guess, window) && out->size() < max_corner_hypotheses) {
                out->push_back(pose);
            }
        }
    }
}

// Poses in the window, a step apart: by rotation, row, column.
class WindowGrid
{
  public:
    WindowGrid(const Pose &guess, const SearchWindow &window)
        : guess_(guess), steps_(static_cast<int>(std::ceil(window.half_m / window_step_m))),
          turns_(static_cast<int>(std::ceil(window.half_rad / window_step_rad)))
    {
    }

    size_t size() const
    {
        return places() * static_cast<size_t>(2 * turns_ + 1);
    }

    Pose pose(size_t k) const
    {
        const int place = static_cast<int>(k % places());
        const int column = place % side() - steps_;
        const int row = place / side() - steps_;
        return {guess_.x + column * window_step_m, guess_.y + row * window_step_m,
                turned(static_cast<int>(k / places()) - turns_)};
    }

    // Appends the score of each pose. The places of one rotation are whole cells apart.
    void add_scores(const std::vector<SurfacePoint> &points, const LikelihoodField &field,
                    std::vector<double> *scores) const
    {
        std::vector<double> sums;
        for (int turn = -turns_; turn <= turns_; turn++) {
            const Eigen::Matrix2d r = rotation(turned(turn));
            sums.assign(places(), 0);
            for (const SurfacePoint &point : points) {
                field.add_likelihoods_around(r * point.p + Eigen::Vector2d(guess_.x, guess_.y), steps_,
                                             window_step_cells, &sums);
            }
            for (const double sum : sums) {
                scores->push_back(points.empty() ? 0 : sum / static_cast<double>(points.size()));
            }
        }
    }

  private:
    int side() const
    {
        return 2 * steps_ + 1;
    }
    size_t places() const
    {
        return static_cast<size_t>(side()) * static_cast<size_t>(side());
    }
    double turned(int turn) const
    {
        return wrapped(guess_.theta + turn * window_step_rad);
    }

    Pose guess_;
    int steps_;
    int turns_;
};

struct Fit {
    Pose pose;
    Eigen::Matrix3d information; // submap frame, rotation about the node
    double overlap;
    double rms_m;
};

// One least-squares pass, point to surface along the normal, with pairs nearer than gate_m.
Fit refine_once(const Pose &pose, const std::vector<SurfacePoint> &points, const LikelihoodField &field,
                double gate_m, const Pairing &pairing)
{
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const Eigen::Matrix2d r = rotation(pose.theta);
    const Eigen::Vector2d t(pose.x, pose.y);
    double sum2 = 0;
    size_t inliers = 0;
    size_t pairs = 0;
    for (const SurfacePoint &point : points) {
        const Eigen::Vector2d lever = r * point.p;
        const SurfacePoint *there = field.nearest(lever + t);
        if (!there || there->normal.isZero()) {
            continue;
        }
        const Eigen::Vector2d n = r * point.normal;
        const bool unknown = point.normal.isZero();
        if (unknown ? pairing.normals_needed : n.dot(there->normal) < pairing.least_cosine) {
            continue;
        }
        const double residual = there->normal.dot(lever + t - there->p);
        if (std::abs(residual) > gate_m) {
            continue;
        }
        const Eigen::Vector3d j(there->normal.x(), there->normal.y(),
                                lever.x() * there->normal.y() - lever.y() * there->normal.x());
        const double x = residual / gate_m;
        const double weight = (1 - x * x) * (1 - x * x);
        h += weight * j * j.transpose();
        b += weight * j * residual;
        pairs++;
        if (std::abs(residual) < inlier_m) {
            inliers++;
            sum2 += residual * residual;
        }
    }
    Fit fit{pose, h / (match_sigma_m * match_sigma_m), 0, 0};
    fit.overlap = points.empty() ? 0 : static_cast<double>(inliers) / static_cast<double>(points.size());
    fit.rms_m = inliers ? std::sqrt(sum2 / static_cast<double>(inliers)) : 0;
    if (pairs >= 10) {
        const Eigen::Matrix3d damped = h + pairing.damping * Eigen::Matrix3d::Identity();
        const Eigen::Vector3d step = -damped.ldlt().solve(b);
        fit.pose = {pose.x + step(0), pose.y + step(1), wrapped(pose.theta + step(2))};
    }
    return fit;
}

template <size_t N>
Fit refine(const Pose &start, const std::vector<SurfacePoint> &points, const LikelihoodField &field,
           const Pass (&passes)[N], const Pairing &pairing)
{
    Fit fit{start, Eigen::Matrix3d::Zero(), 0, 0};
    for (const Pass &pass : passes) {
        for (int k = 0; k < pass.count; k++) {
            fit = refine_once(fit.pose, points, field, pass.gate_m, pairing);
        }
    }
    return fit;
}

// The best hypotheses by a coarse score, from corners and window, scored with more points, best first.
std::vector<Hypothesis> best_scored(const std::vector<Pose> &from_corners, const WindowGrid &window,
                                    const std::vector<SurfacePoint> &scan, const LikelihoodField &field)
{
    const std::vector<SurfacePoint> few = thinned(scan, coarse_points);
    std::vector<double> coarse_scores;
    coarse_scores.reserve(from_corners.size() + window.size());
    for (const Pose &pose : from_corners) {
        coarse_scores.push_back(score_of(pose, few, field));
    }
    window.add_scores(few, field, &coarse_scores);
    const std::vector<SurfacePoint> more = thinned(scan, scored_points);
    std::vector<Hypothesis> chosen;
    for (const size_t k : best_of(coarse_scores, scored_hypotheses)) {
        const Pose pose = k < from_corners.size() ? from_corners[k] : window.pose(k - from_corners.size());
        chosen.push_back({pose, score_of(pose, more, field)});
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const Hypothesis &a, const Hypothesis &b) { return a.score > b.score; });
    return chosen;
}

// The best hypotheses that are different places, best first.
std::vector<Hypothesis> best_distinct(const std::vector<Hypothesis> &all)
{
    std::vector<Hypothesis> best;
    for (const Hypothesis &h : all) {
        const bool is_new = std::all_of(best.begin(), best.end(), [&](const Hypothesis &other) {
            return are_distinct(h.pose, other.pose);
        });
        if (is_new) {
            best.push_back(h);
        }
        if (best.size() == refined_hypotheses) {
            break;
        }
    }
    return best;
}

LoopMatch as_match(const Fit &fit, double ambiguity)
{
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.block<2, 2>(0, 0) = rotation(fit.pose.theta);
    return {true, fit.pose, turn.transpose() * fit.information * turn, fit.overlap, ambiguity, fit.rms_m};
}

} // namespace

std::vector<SurfacePoint> thinned(const std::vector<SurfacePoint> &points, size_t count)
{
    std::vector<SurfacePoint> few;
    const size_t step = std::max<size_t>(1, points.size() / count);
    for (size_t k = 0; k < points.size(); k += step) {
        few.push_back(points[k]);
    }
    return few;
}

double score_of(const Pose &pose, const std::vector<SurfacePoint> &points, const LikelihoodField &field)
{
    const Eigen::Matrix2d r = rotation(pose.theta);
    const Eigen::Vector2d t(pose.x, pose.y);
    double sum = 0;
    for (const SurfacePoint &point : points) {
        sum += field.likelihood(r * point.p + t);
    }
    return points.empty() ? 0 : sum / static_cast<double>(points.size());
}

bool are_distinct(const Pose &a, const Pose &b)
{
    return length(a.x - b.x, a.y - b.y) > distinct_m || std::abs(wrapped(a.theta - b.theta)) > distinct_rad;
}

std::vector<size_t> best_of(const std::vector<double> &scores, size_t count)
{
    std::vector<size_t> order(scores.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
    std::partial_sort(order.begin(), end, order.end(), [&scores](size_t a, size_t b) {
        return scores[a] != scores[b] ? scores[a] > scores[b] : a < b;
    });
    order.erase(end, order.end());
    return order;
}

LoopMatch match_submap(const std::vector<SurfacePoint> &scan, const std::vector<CornerFeature> &corners,
                       const LikelihoodField &field, const std::vector<CornerFeature> &field_corners,
                       const Pose &guess, const SearchWindow &window)
{
    std::vector<Pose> from_corners;
    hypotheses_from_corners(corners, field_corners, guess, window, &from_corners);
    const std::vector<Hypothesis> scored = best_scored(from_corners, WindowGrid(guess, window), scan, field);
    std::vector<Hypothesis> refined;
    std::vector<Fit> fits;
    for (const Hypothesis &h : best_distinct(scored)) {
        fits.push_back(refine(h.pose, scan, field, coarse_to_fine, loose));
        refined.push_back({fits.back().pose, score_of(fits.back().pose, scan, field)});
    }
    if (refined.empty()) {
        return {false, guess, Eigen::Matrix3d::Zero(), 0, 1, 0};
    }
    size_t best = 0;
    for (size_t k = 1; k < refined.size(); k++) {
        best = refined[k].score > refined[best].score ? k : best;
    }
    double other = 0;
    for (const Hypothesis &h : refined) {
        other = are_distinct(h.pose, refined[best].pose) ? std::max(other, h.score) : other;
    }
    return as_match(fits[best], refined[best].score > 0 ? other / refined[best].score : 1);
}

LoopMatch match_locally(const std::vector<SurfacePoint> &scan, const LikelihoodField &field,
                        const Pose &guess)
{
    return as_match(refine(guess, scan, field, coarse_to_fine, loose), 0);
}

LoopMatch match_closely(const std::vector<SurfacePoint> &scan, const LikelihoodField &field,
                        const Pose &guess)
{
    return as_match(refine(guess, scan, field, fine_passes, strict), 0);
}

} // namespace ale
