#include "motion/projection.h"

#include "base/fixed.h"
#include "base/trig.h"

ale_projection_t ale_projection(uint32_t direction_bam)
{
    const ale_direction_t n = ale_direction(direction_bam);
    const int64_t x = ale_round_shift(n.cos_q30, 10);
    const int64_t y = ale_round_shift(n.sin_q30, 10);
    return (ale_projection_t){ale_round_shift(x * x, 20), ale_round_shift(x * y, 20),
                              ale_round_shift(y * y, 20)};
}
