// How near a chain of decisions was to another outcome.
//
// A twin and the integer code it belongs to may decide differently only where a statistic lies so near its
// limit that rounding counts. Every decision of a twin is taken here, and the nearest miss is kept.
#ifndef ALE_TESTS_REFERENCE_DECISIONS_H
#define ALE_TESTS_REFERENCE_DECISIONS_H

#include <algorithm>
#include <cmath>

namespace reference
{

class Decisions
{
  public:
    // Whether the statistic is below its limit (or at it).
    bool below(double statistic, double limit)
    {
        const double scale = std::max({std::fabs(statistic), std::fabs(limit), 1e-12});
        nearest = std::min(nearest, std::fabs(limit - statistic) / scale);
        return statistic <= limit;
    }

    // Relative distance of the nearest miss; infinite when nothing was decided.
    double nearest_miss() const
    {
        return nearest;
    }

    // Residual sums of runs that were asked for: beyond a limit the extractor stops improving.
    void spend(int residual_sums)
    {
        effort += residual_sums;
    }

    int spent() const
    {
        return effort;
    }

    void add(const Decisions &other)
    {
        nearest = std::min(nearest, other.nearest);
    }

  private:
    double nearest = HUGE_VAL;
    int effort = 0;
};

} // namespace reference

#endif
