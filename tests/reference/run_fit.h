// Twin of lib/extract/moments.c: the line through a run and the error that the noise model expects of it.
#ifndef ALE_TESTS_REFERENCE_RUN_FIT_H
#define ALE_TESTS_REFERENCE_RUN_FIT_H

#include "reference/scan_points.h"

namespace reference
{

struct RunFit {
    int n;
    double sse;    // squared distances from the total-least-squares line
    double var;    // of one point along the normal that its own noise explains
    double shared; // of the error that neighbours share, along the normal
    double along2; // squared distances from the mean along the line
    double alpha;  // normal form, rho >= 0
    double rho;
    double mean_along; // of the points' mean, along (-sin alpha, cos alpha)

    double chi() const
    {
        return sse / var;
    }
};

RunFit fit_run(const ScanPoints &points, const NoiseOfScan &noise, int first, int last);

double sse_of_run(const ScanPoints &points, int first, int last);

// The largest chi square of n points about their own line that z deviations allow.
double chi_limit(int n, double z);

constexpr double chi_low_z = 3;
constexpr double chi_high_z = 4;

// How many of n points err together, when the shared error is one draw for so many beams.
double points_together(const NoiseOfScan &noise, int n);

} // namespace reference

#endif
