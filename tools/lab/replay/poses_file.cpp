#include "lab/replay/poses_file.h"

extern "C" {
#include "base/fixed.h"
#include "lcm/wheel_words.h"
}

namespace ale
{

void PosesFile::put_pose(const ale_pose_t &pose, const char *prefix)
{
    file_.put(",\"").put(prefix).put("x\":").put_decimal(pose.x_um, 6);
    file_.put(",\"").put(prefix).put("y\":").put_decimal(pose.y_um, 6);
    file_.put(",\"").put(prefix).put("theta\":").put_angle(pose.theta_bam);
}

/* um^2, um nrad and nrad^2, by how many of row and column are the angle. */
void PosesFile::put_covariance(const int64_t (&cov)[9])
{
    for (int i = 0; i < 9; i++) {
        const int angles = (i / 3 == 2) + (i % 3 == 2);
        file_.put(i ? "," : "").put_scaled(cov[i], -12 - 3 * angles);
    }
}

/* Per mm^2, mm mrad, mrad^2 and times 2^20 in the core: per m^2, m rad, rad^2 here, to a thousandth. */
void PosesFile::put_information(const int64_t (&information)[6])
{
    constexpr int64_t thousandths_per_si = 1000000000;
    for (int i = 0; i < 6; i++) {
        file_.put(i ? "," : "").put_decimal(ale_mul_shift(information[i], thousandths_per_si, 20), 3);
    }
}

void PosesFile::put(const ale_estimate_t &estimate)
{
    file_.put("{\"scan\":").put_integer(estimate.scan).put(",\"t\":").put_decimal(estimate.stamp_us, 6);
    put_pose(estimate.smooth, "");
    put_pose(estimate.map, "map_");
    file_.put(",\"cov\":[");
    put_covariance(estimate.cov);
    file_.put("],\"state\":").put_integer(estimate.state).put(",\"information\":[");
    put_information(estimate.information);
    file_.put("],\"lag_us\":").put_integer(estimate.lag_us);
    file_.put(",\"matched_lines\":").put_integer(estimate.matched_lines);
    file_.put(",\"matched_corners\":").put_integer(estimate.matched_corners);
    file_.put(estimate.predicted ? ",\"predicted\":true" : ",\"predicted\":false");
    file_.put(",\"map_id\":").put_integer(estimate.map_id).put(",\"maps\":").put_integer(estimate.maps);
    file_.put(",\"wheel_fault\":\"").put(ale_wheel_fault_word(estimate.wheel_fault)).put("\"}\n");
}

} // namespace ale
