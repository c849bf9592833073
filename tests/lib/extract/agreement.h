// Whether a stage in integers decides as its twin in double does.
//
// They may differ only where a decision of the twin was a near miss, a statistic within 2 % of its limit or
// of another one that it is compared with: the line fits of the integer code are exact to less than that. How
// often that happens is bounded too.
#ifndef ALE_TESTS_LIB_EXTRACT_AGREEMENT_H
#define ALE_TESTS_LIB_EXTRACT_AGREEMENT_H

#include <gtest/gtest.h>

#include "reference/decisions.h"

namespace scene
{

class agreement
{
  public:
    void compare(bool same, const reference::Decisions &decisions, unsigned scan)
    {
        compared++;
        different += same ? 0 : 1;
        EXPECT_TRUE(same || decisions.nearest_miss() < 0.02)
            << "scan " << scan << ": nearest miss " << decisions.nearest_miss();
    }

    void expect_differences_below(double share) const
    {
        EXPECT_GT(compared, 0);
        EXPECT_LE(different, share * compared) << different << " of " << compared;
    }

  private:
    int compared = 0;
    int different = 0;
};

} // namespace scene

#endif
