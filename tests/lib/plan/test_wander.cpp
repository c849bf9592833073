// lib/plan/wander.c: what a lost robot does, in a room where its true place is known to the test alone.
#include <cmath>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "plan/wander.h"
}

namespace
{

class Wander : public ::testing::Test
{
  protected:
    Wander()
    {
        ale_wander_begin(&wander_);
    }

    ale_scan_t scan()
    {
        room::Sensor sensor;
        sensor.beam_time_ns = 0;
        return room::scan_at(
            walls_, sensor, [&](double) { return pose_; }, 0.1 * steps_, rng_);
    }

    // The robot does at once what it is told, for a tenth of a second.
    ale_velocity_t step()
    {
        const ale_scan_t seen = scan();
        const ale_velocity_t velocity = ale_wander_step(&wander_, &follower_, &seen);
        pose_ = reference::compose(pose_, {velocity.speed_um_s * 1e-7, 0, velocity.turn_urad_s * 1e-7});
        steps_++;
        return velocity;
    }

    double nearest() const
    {
        double best = 1e9;
        for (int k = 0; k < 36; k++) {
            best = std::min(best, room::distance(walls_, pose_[0], pose_[1], k * reference::pi / 18));
        }
        return best;
    }

    ale_wander_t wander_;
    ale_follower_t follower_{ale_robot_shape_default(), {}, 400000, 800000};
    std::vector<room::Wall> walls_ = room::l_shape();
    reference::Pose pose_{0.5, -0.5, 0.3};
    std::mt19937 rng_{1};
    int steps_ = 0;
};

} // namespace

TEST_F(Wander, StandsForThreeSecondsThenTurnsOnceRound)
{
    double turned = 0;
    for (int k = 0; k < 30 + 157; k++) {
        const ale_velocity_t velocity = step();
        EXPECT_EQ(velocity.speed_um_s, 0);
        EXPECT_EQ(velocity.turn_urad_s, k < 30 ? 0 : 400000);
        turned += velocity.turn_urad_s * 1e-7;
    }
    EXPECT_NEAR(turned, 2 * reference::pi, 0.05);
}

TEST_F(Wander, ThenDrivesAboutAtHalfTheSpeedWithoutTouchingAnything)
{
    wander_.steps = 30 + 157;
    double driven = 0;
    for (int k = 0; k < 400; k++) {
        const ale_velocity_t velocity = step();
        EXPECT_TRUE(velocity.speed_um_s >= 0 && velocity.speed_um_s <= follower_.speed_um_s / 2);
        ASSERT_GT(nearest(), 0.2) << "step " << k;
        driven += velocity.speed_um_s * 1e-7;
    }
    EXPECT_GT(driven, 2);
}

TEST_F(Wander, GivesUpAfterThreeMinutesAndBeginsAnewWhenItIsLostAgain)
{
    const ale_scan_t seen = scan();
    for (int k = 0; k < 1800; k++) {
        EXPECT_TRUE(ale_wander_is_active(&wander_));
        ale_wander_step(&wander_, &follower_, &seen);
    }
    EXPECT_FALSE(ale_wander_is_active(&wander_));
    const ale_velocity_t velocity = ale_wander_step(&wander_, &follower_, &seen);
    EXPECT_TRUE(velocity.speed_um_s == 0 && velocity.turn_urad_s == 0);
    ale_wander_begin(&wander_);
    EXPECT_TRUE(ale_wander_is_active(&wander_));
}
