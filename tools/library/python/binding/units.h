/* The core's integers to SI and back. Whole numbers divided by a power of ten are the double nearest to the
 * decimal that ale-replay prints. */
#ifndef ALE_PYTHON_UNITS_H
#define ALE_PYTHON_UNITS_H

#include <cmath>
#include <cstdint>

extern "C" {
#include "base/trig.h"
}

namespace ale::binding
{

constexpr double micro = 1e6;
constexpr double nano = 1e9;
constexpr double bam_per_radian = 4294967296.0 / 6.283185307179586476925;

inline double metres(int64_t um)
{
    return static_cast<double>(um) / micro;
}
inline double seconds(int64_t us)
{
    return static_cast<double>(us) / micro;
}
/* -pi to pi. */
inline double radians(uint32_t bam)
{
    return static_cast<double>(ale_bam_to_nrad(ale_bam_diff(bam, 0))) / nano;
}
/* 0 to pi. */
inline double opening_radians(uint32_t bam)
{
    return static_cast<double>(ale_bam_to_nrad(static_cast<int32_t>(bam / 2)) * 2) / nano;
}
/* value um or um^2, um nrad, nrad^2: 10^digits to one of SI. */
inline double scaled(int64_t value, int digits)
{
    constexpr double powers[] = {1e12, 1e15, 1e18};
    return static_cast<double>(value) / powers[(digits - 12) / 3];
}

/* Finite numbers within range: whoever calls has checked (ale/_checks.py). */
inline int32_t um_of(double m)
{
    return static_cast<int32_t>(std::llround(m * micro));
}
inline int64_t us_of(double s)
{
    return std::llround(s * micro);
}
inline uint32_t bam_of(double rad)
{
    return static_cast<uint32_t>(std::llround(std::remainder(rad, 6.283185307179586476925) * bam_per_radian));
}

} // namespace ale::binding

#endif
