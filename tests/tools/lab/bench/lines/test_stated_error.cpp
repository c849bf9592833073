// Whether lines are told with the uncertainty that they have.
#include <gtest/gtest.h>

#include "lab/bench/lines/stated_error.hpp"
#include "lab/bench/random.hpp"

namespace
{

using namespace bench;

// Scans of one surface across the direction where angles wrap, with this deviation and what is told of it.
std::vector<std::vector<Line>> scans_of(double deviation, double stated)
{
    Random random(3);
    std::vector<std::vector<Line>> scans;
    for (int k = 0; k < 2000; k++) {
        Line line;
        line.first = 100;
        line.last = 120;
        line.form.alpha = wrapped(pi + deviation * random.normal());
        line.sigma_alpha = stated;
        scans.push_back({line});
    }
    return scans;
}

TEST(StatedError, IsOneWhereLinesScatterAsTheySay)
{
    const StatedError right = stated_error(scans_of(0.02, 0.02));
    EXPECT_EQ(right.surfaces, 1);
    EXPECT_NEAR(right.squared, 1, 0.1);
    EXPECT_NEAR(stated_error(scans_of(0.04, 0.02)).squared, 4, 0.4);
}

TEST(StatedError, LeavesOutWhatIsSeldomSeenOrToldWithoutUncertainty)
{
    std::vector<std::vector<Line>> scans = scans_of(0.02, 0.02);
    scans.front().push_back(scans.front().front());
    scans.front().back().first = 300;
    scans.front().back().last = 320;
    EXPECT_EQ(stated_error(scans).surfaces, 1);
    EXPECT_EQ(stated_error(scans_of(0.02, 0)).surfaces, 0);
}

} // namespace
