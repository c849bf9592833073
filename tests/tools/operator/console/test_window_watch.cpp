// Dirt on the window is what stays with the beam while the robot turns; what it meets does not.
#include "operator/console/window_watch.h"

#include <gtest/gtest.h>

using console::WindowWatch;

namespace
{

constexpr size_t beams = 682;
constexpr float step = 0.00613592F;

ale::scan_t clean_scan()
{
    ale::scan_t scan{};
    scan.first_bearing = -340 * step;
    scan.step = step;
    scan.codes.assign(beams, 0);
    return scan;
}

ale::scan_t with_code(size_t first, size_t last, uint8_t code)
{
    ale::scan_t scan = clean_scan();
    for (size_t k = first; k <= last; k++) {
        scan.codes[k] = code;
    }
    return scan;
}

constexpr uint8_t weak = 1;
constexpr uint8_t nothing_in_reach = 129;

} // namespace

TEST(WindowWatch, NeighbouringBeamsThatStayWeakThroughAQuarterTurnAreAStain)
{
    WindowWatch watch;
    for (int k = 0; k < 200; k++) {
        watch.scan(with_code(500, 519, weak), 3.0 + 0.01 * k); // over the jump at half a turn
    }
    const auto stain = watch.stain();
    ASSERT_TRUE(stain);
    EXPECT_EQ(stain->beams, 20);
    EXPECT_NEAR(stain->bearing, (509.5 - 340) * static_cast<double>(step), 1e-4);
}

TEST(WindowWatch, WhatTheBeamMeetsIsNone)
{
    WindowWatch standing;
    WindowWatch passing;
    WindowWatch open;
    WindowWatch few;
    for (int k = 0; k < 300; k++) {
        standing.scan(with_code(500, 519, weak), 0.3);
        const auto first = static_cast<size_t>(400 - k); // a dark wall goes by as the robot turns
        passing.scan(with_code(first, first + 60, weak), 0.01 * k);
        open.scan(with_code(300, 600, nothing_in_reach), 0.01 * k);
        few.scan(with_code(500, 503, weak), 0.01 * k);
    }
    EXPECT_FALSE(standing.stain());
    EXPECT_FALSE(passing.stain());
    EXPECT_FALSE(open.stain());
    EXPECT_FALSE(few.stain());
}

TEST(WindowWatch, WipedItIsForgottenAtOnce)
{
    WindowWatch watch;
    for (int k = 0; k < 200; k++) {
        watch.scan(with_code(0, 40, weak), 0.01 * k);
    }
    ASSERT_TRUE(watch.stain());
    watch.scan(clean_scan(), 2);
    EXPECT_FALSE(watch.stain());
}
