/* Where measurements come from: a simulated world or a recorded log, as events in the order in which
 * they become known. */
#ifndef ALE_LAB_SIM_SOURCE_H
#define ALE_LAB_SIM_SOURCE_H

#include <cstdint>
#include <optional>
#include <variant>

#include "lab/sim/device/scanner.h"
#include "lab/sim/device/sweep.h"

namespace sim
{

/* Odometry as the wheels' computer sends it; stamp in microseconds of play. */
struct OdometryReport {
    int64_t stamp_us = 0;
    Pose pose;
};

using Event = std::variant<Turn, OdometryReport, Sweep>;

/* A turn is known when it is over and the device has had this long to prepare the reply. */
constexpr int64_t reply_delay_us = 1000;

class Source
{
  public:
    virtual ~Source() = default;

    virtual const Scanner &scanner() const = 0;

    /* When the next event becomes known, in microseconds of play; nothing when it is all over. */
    virtual std::optional<int64_t> due_us() = 0;

    /* The next event; only while due_us() has a value, and not before that time. */
    virtual Event next() = 0;

    /* Where the robot truly was; nothing when nobody knows. Only for times that have been played. */
    virtual std::optional<Pose> truth(int64_t play_us) = 0;
};

} // namespace sim

#endif
