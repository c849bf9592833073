// Twin of lib/extract/scan_noise.c and histogram.c: the noise of a scan, measured in it.
#ifndef ALE_TESTS_REFERENCE_SCAN_NOISE_H
#define ALE_TESTS_REFERENCE_SCAN_NOISE_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// Quantile of values that are counted in bins, four to the octave, beginning at 0, 1, 2, 3, 4, 6, 8, ...:
// linear within the bin.
double binned_quantile(const std::vector<double> &values, double share);

// Own noise from second differences of 1/range, by their third quartile in octaves of the range; prior where
// there are too few. step: angle from beam to beam, radians.
NoiseOfScan own_noise(const ScanPoints &points, const NoiseOfScan &prior, double step);

// The shared part in units of the prior's, from second differences of blocks of eight beams: 1 where there
// is too little to tell, up to 1 where there is none.
struct SharedNoise {
    double scale;
    double stated; // the same for the covariance of lines, which has no margin; 1 where nothing shows
    bool absent;   // measured, and there is none
};
SharedNoise shared_noise(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                         double step, Decisions &decisions);

// Correction of the own variance by the residuals of the runs.
double own_scale(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                 Decisions &decisions);

} // namespace reference

#endif
