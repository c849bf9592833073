#include "robot/calibrate/mixed_pixels.h"

#include <algorithm>
#include <cmath>

#include "robot/calibrate/statistics.h"

namespace calibrate
{

namespace
{

constexpr double least_jump = 0.2;
constexpr double least_margin = 0.03; /* of a value in between from either side */

/* The steady distance on one side of an edge, a little away from it. */
struct Side {
    bool steady = false;
    double range = 0;
    double sigma = 0;
};

Side side_of(const std::vector<Beam> &beams, size_t beam)
{
    const Beam &b = beams[beam];
    return {b.seen && b.sigma < least_margin, b.mean, b.sigma};
}

/* Share of the scans in which the beam at the edge lies in between; what falls within the margins is not
 * seen, which the share of the jump that they take corrects. */
double share_between(const Recording &recording, Eigen::Index beam, double low, double high, double margin)
{
    int between = 0;
    int seen = 0;
    for (const double range : recording.range.col(beam)) {
        seen += !std::isnan(range);
        between += range > low + margin && range < high - margin;
    }
    return seen > 0 ? between / (seen * (1 - 2 * margin / (high - low))) : 0;
}

} // namespace

MixedPixels count_mixed_pixels(const Recording &recording, const std::vector<Beam> &beams)
{
    MixedPixels mixed;
    double sum = 0;
    for (size_t k = 1; k + 2 < beams.size(); k++) {
        const Side before = side_of(beams, k - 1);
        const Side after = side_of(beams, k + 2);
        const bool edge_here =
            beams[k].seen && beams[k + 1].seen && std::abs(beams[k + 1].mean - beams[k].mean) > least_jump;
        if (!before.steady || !after.steady || !edge_here ||
            std::abs(before.range - after.range) < least_jump) {
            continue;
        }
        const auto [low, high] = std::minmax({before.range, after.range});
        const double margin = std::max(least_margin, 6 * std::max(before.sigma, after.sigma));
        if (high - low <= 3 * margin) {
            continue;
        }
        const auto beam = static_cast<Eigen::Index>(k);
        sum += share_between(recording, beam, low, high, margin) +
               share_between(recording, beam + 1, low, high, margin);
        mixed.edges++;
    }
    mixed.share = mixed.edges > 0 ? sum / mixed.edges : 0;
    return mixed;
}

} // namespace calibrate
