#include "common/export/trajectory.h"

extern "C" {
#include "base/fixed.h"
#include "base/trig.h"
}

namespace ale
{

namespace
{

constexpr int64_t billion = 1000000000;

TextFile &put_q30(TextFile &file, int32_t value_q30)
{
    return file.put(" ").put_decimal(ale_round_shift(value_q30 * billion, 30), 9);
}

} // namespace

void put_tum_line(TextFile &file, const StampedPose &stamped)
{
    const ale_pose_t &pose = stamped.pose;
    const auto half_bam = static_cast<uint32_t>(ale_bam_diff(pose.theta_bam, 0) / 2);
    file.put_decimal(stamped.stamp_us, 6);
    file.put(" ").put_decimal(pose.x_um, 6).put(" ").put_decimal(pose.y_um, 6).put(" 0 0 0");
    put_q30(put_q30(file, ale_sin_q30(half_bam)), ale_cos_q30(half_bam)).put("\n");
}

} // namespace ale
