/* How the robot is, on /diagnostics: once a second, also while nothing is heard of it (STALE).
 *
 *   ale-slam: tracking       state, the map, the wheels
 *   ale-slam: scanner        what the driver says, rate, what was dropped and why
 *   ale-slam: real time      what the kernel gives, deadlines, latency
 *   ale-ros2: commands       what was sent, what was refused and why
 *
 * One thread. */
#ifndef ROS2_DIAGNOSTICS_H
#define ROS2_DIAGNOSTICS_H

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "diagnostic_msgs.h"
#include "operator/ros2/dds.h"
#include "operator/ros2/ros_commands.h"

namespace ros2
{

/* One line of /diagnostics. */
struct Finding {
    enum Level : uint8_t { ok, warn, error, stale };
    Level level = ok;
    std::string name;
    std::string message;
    std::string hardware;
    std::vector<std::pair<std::string, std::string>> values;
};

/* What a status says; tracking: nullptr, none was heard. Pure. */
std::vector<Finding> findings_of(const ale::status_t &status, const ale::tracking_t *tracking);

class Diagnostics
{
  public:
    explicit Diagnostics(const Participant &participant);

    void take(const ale::status_t &status);
    void take(const ale::tracking_t &tracking)
    {
        tracking_ = tracking;
    }
    void send(const RosCommands &commands, bool has_key);

  private:
    using Clock = std::chrono::steady_clock;

    std::vector<Finding> of_robot() const;

    Writer<diagnostic_msgs_msg_dds__DiagnosticArray_> writer_;
    std::optional<ale::status_t> status_;
    Clock::time_point heard_{};
    std::optional<ale::tracking_t> tracking_;
};

} // namespace ros2

#endif
