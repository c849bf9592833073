// lib/motion/wheel_scale.c: the factor of the wheels against least squares with a prior, in double, and what
// it is after ways that teach little.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "convert.h"

extern "C" {
#include "motion/wheel_scale.h"
}

namespace
{

constexpr double end_m = 0.004; // of matching, as the unit has it
constexpr int32_t prior_ppm = 50000;

ale_wheel_scale_t fresh()
{
    ale_wheel_scale_t scale;
    ale_wheel_scale_init(&scale, prior_ppm);
    return scale;
}

double factor_of(const ale_wheel_scale_t &scale)
{
    return ale_wheel_scale_apply(&scale, 1000000000) / 1e9;
}

// Drives by steps between poses that are known to 3 mm, each sigma.
class Drive
{
  public:
    explicit Drive(double true_factor) : factor_(true_factor)
    {
    }
    // By what the wheels count, a way that goes on unless `apart`.
    void step(double counted_m, bool apart = false)
    {
        at_us_ += apart ? 100000 : 0;
        const double error_m = noise_(rng_);
        const double before_m = apart ? noise_(rng_) : last_error_m_;
        const double found_m = factor_ * counted_m + error_m - before_m;
        const ale_wheel_lesson_t lesson = {at_us_, at_us_ + 100000, convert::um(found_m),
                                           convert::um(counted_m), 0};
        ale_wheel_scale_learn(&scale, &lesson);
        last_error_m_ = error_m;
        at_us_ += 100000;
    }

    ale_wheel_scale_t scale = fresh();

  private:
    double factor_;
    std::mt19937 rng_{3};
    std::normal_distribution<double> noise_{0, 0.003};
    double last_error_m_ = 0;
    int64_t at_us_ = 0;
};

} // namespace

TEST(WheelScale, BeforeAnythingIsLearntIsOneAndItsPrior)
{
    const ale_wheel_scale_t scale = fresh();
    EXPECT_EQ(ale_wheel_scale_apply(&scale, 123456), 123456);
    EXPECT_NEAR(static_cast<double>(ale_wheel_scale_sigma_ppm(&scale)), prior_ppm, 20);
    EXPECT_NEAR(static_cast<double>(ale_wheel_scale_error_ppm(&scale)), prior_ppm, 20);
}

TEST(WheelScale, IsTheMeanOfPriorAndWaysByTheirWeights)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> way(0.02, 0.4);
    std::bernoulli_distribution goes_on(0.7);
    ale_wheel_scale_t scale = fresh();
    double counted_m = 0;
    double excess_m = 0;
    double ends_m2 = 2 * end_m * end_m;
    int64_t at_us = 0;
    for (int k = 0; k < 40; k++) {
        const double step_m = way(rng);
        const bool on = k > 0 && goes_on(rng);
        at_us += on ? 0 : 50000;
        const double found_m = step_m * 1.06;
        const ale_wheel_lesson_t lesson = {at_us, at_us + 100000, convert::um(found_m), convert::um(step_m),
                                           0};
        ale_wheel_scale_learn(&scale, &lesson);
        at_us += 100000;
        counted_m += step_m;
        excess_m += found_m - step_m;
        ends_m2 += on || k == 0 ? 0 : 2 * end_m * end_m;
        const double prior = ends_m2 / (0.05 * 0.05);
        const double weight = counted_m * counted_m + prior;
        ASSERT_NEAR(factor_of(scale), 1 + excess_m * counted_m / weight, 3e-5);
        ASSERT_NEAR(static_cast<double>(ale_wheel_scale_sigma_ppm(&scale)),
                    std::max(2000.0, std::sqrt(ends_m2 / weight) * 1e6), 5);
    }
}

TEST(WheelScale, OfADriveIsFoundWithinItsSigma)
{
    for (const double truth : {0.85, 0.95, 1.0, 1.1, 1.15}) {
        Drive drive(truth);
        for (int k = 0; k < 200; k++) {
            drive.step(0.05);
        }
        EXPECT_NEAR(factor_of(drive.scale), truth, 0.002) << truth;
        EXPECT_EQ(ale_wheel_scale_sigma_ppm(&drive.scale), 2000);
    }
}

TEST(WheelScale, IsNotLearntFromTheNoiseOfARobotThatTurnsOnTheSpot)
{
    Drive drive(1.0);
    std::mt19937 rng(5);
    std::normal_distribution<double> wobble(0, 0.002);
    for (int k = 0; k < 500; k++) {
        drive.step(wobble(rng), k % 3 == 0);
        ASSERT_NEAR(factor_of(drive.scale), 1.0, 0.02) << k;
    }
    EXPECT_GT(ale_wheel_scale_sigma_ppm(&drive.scale), 30000);
}

TEST(WheelScale, OfShortWaysApartFromOneAnotherIsLearntAsSlowlyAsTheyTell)
{
    Drive apart(1.1);
    Drive in_one(1.1);
    for (int k = 0; k < 30; k++) {
        apart.step(0.02, true);
        in_one.step(0.02);
    }
    EXPECT_GT(ale_wheel_scale_sigma_ppm(&apart.scale), 2 * ale_wheel_scale_sigma_ppm(&in_one.scale));
    EXPECT_NEAR(factor_of(apart.scale), 1.1,
                3e-6 * static_cast<double>(ale_wheel_scale_sigma_ppm(&apart.scale)));
}

TEST(WheelScale, ForgetsWheelsThatHaveChanged)
{
    Drive drive(0.95);
    for (int k = 0; k < 600; k++) {
        drive.step(0.05);
    }
    Drive changed(1.05);
    changed.scale = drive.scale;
    for (int k = 0; k < 3000; k++) {
        changed.step(0.05);
    }
    EXPECT_NEAR(factor_of(changed.scale), 1.05, 0.004);
}

TEST(WheelScale, IgnoresWheelsThatSpin)
{
    Drive drive(1.0);
    for (int k = 0; k < 50; k++) {
        drive.step(0.05);
    }
    const ale_wheel_scale_t before = drive.scale;
    const ale_wheel_lesson_t spins = {5000000, 5100000, 10000, 200000, 0};
    ale_wheel_scale_learn(&drive.scale, &spins);
    EXPECT_EQ(ale_wheel_scale_apply(&drive.scale, 1000000), ale_wheel_scale_apply(&before, 1000000));
}
