#include <cmath>
#include <gtest/gtest.h>

extern "C" {
#include "motion/projection.h"
}

namespace
{

constexpr double one_q20 = 1 << 20;

TEST(Projection, IsTheDirectionTimesItself)
{
    for (int degrees = 0; degrees < 360; degrees += 7) {
        const double angle = degrees * M_PI / 180;
        const auto bam =
            static_cast<uint32_t>(static_cast<uint64_t>(std::llround(degrees / 360.0 * std::ldexp(1, 32))));
        const ale_projection_t p = ale_projection(bam);
        EXPECT_NEAR(static_cast<double>(p.xx_q20) / one_q20, std::cos(angle) * std::cos(angle), 3e-6);
        EXPECT_NEAR(static_cast<double>(p.xy_q20) / one_q20, std::cos(angle) * std::sin(angle), 3e-6);
        EXPECT_NEAR(static_cast<double>(p.yy_q20) / one_q20, std::sin(angle) * std::sin(angle), 3e-6);
    }
}

} // namespace
