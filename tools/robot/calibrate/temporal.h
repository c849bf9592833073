/* What changes from scan to scan: the error of each beam's own, of its bearing, and the part that
 * neighbouring beams share.
 *
 * With e_i the deviation of beam i from its mean over the scans, d_i that mean and g_i = dr/dphi,
 *     E[e_i e_j] = shared(d_i, d_j) exp(-|i - j| / length) + [i = j] (own^2 + (part d_i)^2 + (bearing
 * g_i)^2), which is linear in the squares, so that they follow from weighted least squares over all pairs of
 * beams of one surface, and the length from a search. */
#ifndef ALE_ROBOT_CALIBRATE_TEMPORAL_H
#define ALE_ROBOT_CALIBRATE_TEMPORAL_H

#include <vector>

#include "robot/calibrate/recording.h"

namespace calibrate
{

constexpr int longest_lag = 40; /* beams */

/* One beam over the recording. */
struct Beam {
    bool usable = false; /* seen in at least half of the scans, not at a depth edge */
    bool seen = false;   /* seen in at least half of the scans */
    double mean = 0;     /* metres, without strays */
    double sigma = 0;    /* robust */
    double slope = 0;    /* dr/dphi, metres per radian */
    int surface = 0;     /* beams of one number lie on one surface */
};

std::vector<Beam> beams_of(const Recording &recording);

/* Mean of e_i e_(i + lag) over the scans. */
struct Product {
    int beam;
    int lag;
    double mean;
    int count;
};

std::vector<Product> deviation_products(const Recording &recording, const std::vector<Beam> &beams);

/* Variances: m^2, parts of the square of the range, rad^2. */
struct TemporalFit {
    double own = 0;
    double own_relative = 0;
    double bearing = 0;
    double shared = 0;
    double shared_relative = 0;
    double length = 12; /* beams */

    double shared_between(double d, double e) const
    {
        return shared + shared_relative * d * e;
    }
    double own_of(const Beam &beam) const
    {
        return own + own_relative * beam.mean * beam.mean + bearing * beam.slope * beam.slope;
    }
};

/* Throws std::runtime_error when too few beams are usable. */
TemporalFit fit_temporal(const std::vector<Beam> &beams, const std::vector<Product> &products);

} // namespace calibrate

#endif
