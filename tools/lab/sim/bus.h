/* The robot's other messages: wheel odometry out, and for --drive the velocity set point in. */
#ifndef ALE_LAB_SIM_BUS_H
#define ALE_LAB_SIM_BUS_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "lab/sim/world/robot.h"

extern "C" {
#include "lcm/bus.h"
#include "lcm/wire.h"
}

namespace sim
{

/* Publishes ALE_ODOMETRY. Throws std::runtime_error when LCM cannot be had. */
class OdometryOut
{
  public:
    explicit OdometryOut(const std::string &url);
    void publish(int64_t utime, const Pose &pose);

  private:
    struct Close {
        void operator()(ale_bus_t *bus) const
        {
            ale_bus_close(bus);
        }
    };
    std::unique_ptr<ale_bus_t, Close> bus_;
};

/* Listens to ALE_DRIVE. A set point holds for half a second of the sender's silence, then the motors stop. */
class DriveIn
{
  public:
    static constexpr int64_t too_early_us = INT64_MIN / 2; /* a time at which nothing holds */

    explicit DriveIn(const std::string &url);

    int descriptor() const;
    /* Takes what has come; now_us is the simulated time. What is not taken keeps the descriptor ready. */
    void receive(int64_t now_us);
    Twist command(int64_t now_us) const;

  private:
    static void take(void *self, const char *channel, const uint8_t *bytes, size_t count);

    struct Close {
        void operator()(ale_wire_t *wire) const
        {
            ale_wire_close(wire);
        }
    };
    std::unique_ptr<ale_wire_t, Close> wire_;
    Twist command_;
    int64_t now_us_ = 0;
    int64_t taken_us_ = too_early_us;
};

} // namespace sim

#endif
