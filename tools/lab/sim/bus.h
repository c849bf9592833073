/* The robot's other messages: wheel odometry out, and for --drive the velocity set point in. */
#ifndef ALE_LAB_SIM_BUS_H
#define ALE_LAB_SIM_BUS_H

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "lab/sim/world/robot.h"

extern "C" {
#include "lcm/bus.h"
#include "lcm/wire.h"
#include "motor/receiver.h"
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

/* Listens to ALE_DRIVE. A set point holds for half a second of the sender's silence, then the motors stop.
 * With a key it is a motor controller as drivers/motor has it: it obeys ALE_DRIVE_KEYED alone. */
class DriveIn
{
  public:
    static constexpr int64_t too_early_us = INT64_MIN / 2; /* a time at which nothing holds */

    /* key_file empty: none. Throws std::runtime_error when LCM or the key cannot be had. */
    explicit DriveIn(const std::string &url, const std::string &key_file = "");

    int descriptor() const;
    /* Takes what has come; now_us is the simulated time. What is not taken keeps the descriptor ready. */
    void receive(int64_t now_us);
    Twist command(int64_t now_us) const;

  private:
    static void take(void *self, const char *channel, const uint8_t *bytes, size_t count);
    static void take_keyed(void *self, const char *channel, const uint8_t *bytes, size_t count);
    void read_key(const std::string &key_file);
    void say_ready();

    struct Close {
        void operator()(ale_wire_t *wire) const
        {
            ale_wire_close(wire);
        }
    };
    std::unique_ptr<ale_wire_t, Close> wire_;
    bool keyed_ = false;
    ale_motor_t motor_{};
    std::chrono::steady_clock::time_point ready_{};
    Twist command_;
    int64_t now_us_ = 0;
    int64_t taken_us_ = too_early_us;
};

} // namespace sim

#endif
