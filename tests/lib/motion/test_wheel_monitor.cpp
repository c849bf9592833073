extern "C" {
#include "motion/wheel_monitor.h"
}

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace
{

constexpr double bam_per_rad = 683565275.6;

ale_pose_t displacement(double ahead_m, double turn_rad)
{
    return {static_cast<int32_t>(std::lround(ahead_m * 1e6)), 0,
            static_cast<uint32_t>(static_cast<int64_t>(std::llround(turn_rad * bam_per_rad)))};
}

struct Step {
    double ahead_m;
    double turn_rad;
};

// A robot that speeds up, slows down and turns to either side.
Step step_at(int k)
{
    return {0.05 + 0.03 * std::sin(0.7 * k), 0.08 * std::sin(0.45 * k)};
}

// What is said after so many scans of wheels that tell `told` of the k-th step.
ale_wheel_monitor_t drive(int scans, const std::function<Step(int)> &told)
{
    std::mt19937 rng(3);
    std::normal_distribution<double> noise(0, 0.002);
    ale_wheel_monitor_t monitor;
    ale_wheel_monitor_init(&monitor);
    for (int k = 0; k < scans; k++) {
        const Step counted = told(k);
        const Step found = step_at(k);
        ale_wheel_monitor_compare(&monitor, displacement(counted.ahead_m, counted.turn_rad),
                                  displacement(found.ahead_m + noise(rng), found.turn_rad + noise(rng)));
    }
    return monitor;
}

constexpr int three_seconds = 30;

TEST(WheelMonitor, WheelsThatErrAsWheelsDoAreFine)
{
    const auto m = drive(600, [](int k) {
        return Step{1.05 * step_at(k).ahead_m, 0.93 * step_at(k).turn_rad};
    });
    EXPECT_EQ(m.fault, ALE_WHEELS_FINE);
    EXPECT_EQ(m.faults, 0u);
}

TEST(WheelMonitor, ARobotAtRestSaysNothing)
{
    ale_wheel_monitor_t m;
    ale_wheel_monitor_init(&m);
    for (int k = 0; k < 100; k++) {
        ale_wheel_monitor_compare(&m, displacement(0, 0), displacement(0.001, 0.0005));
    }
    EXPECT_EQ(m.fault, ALE_WHEELS_FINE);
}

TEST(WheelMonitor, NamesWhatIsWrongWithinThreeSeconds)
{
    EXPECT_EQ(drive(three_seconds, [](int) { return Step{0, 0}; }).fault, ALE_WHEELS_STALLED);
    EXPECT_EQ(drive(three_seconds,
                    [](int k) {
                        return Step{-step_at(k).ahead_m, -step_at(k).turn_rad};
                    })
                  .fault,
              ALE_WHEELS_REVERSED);
    EXPECT_EQ(drive(three_seconds,
                    [](int k) {
                        return Step{3 * step_at(k).ahead_m, 3 * step_at(k).turn_rad};
                    })
                  .fault,
              ALE_WHEELS_SCALE);
}

TEST(WheelMonitor, CountsEachFaultOnceAndForgivesIt)
{
    const auto m = drive(300, [](int k) { return k / 50 % 2 == 1 ? Step{0, 0} : step_at(k); });
    EXPECT_EQ(m.faults, 3u);
    EXPECT_EQ(drive(350, [](int k) { return k < 50 ? Step{0, 0} : step_at(k); }).fault, ALE_WHEELS_FINE);
}

TEST(WheelMonitor, WheelsThatAreLateAreCalledThat)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> any(-1, 1);
    Step step[200];
    for (Step &s : step) {
        s = {0.08 * any(rng), 0.3 * any(rng)};
    }
    ale_wheel_monitor_t m;
    ale_wheel_monitor_init(&m);
    for (int k = 0; k < 200; k++) {
        const Step told = k < 4 ? Step{0, 0} : step[k - 4];
        ale_wheel_monitor_compare(&m, displacement(told.ahead_m, told.turn_rad),
                                  displacement(step[k].ahead_m, step[k].turn_rad));
    }
    EXPECT_EQ(m.fault, ALE_WHEELS_LATE);
}

} // namespace
