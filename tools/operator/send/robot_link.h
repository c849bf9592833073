/* One robot as an operator's program sees it: its newest status, and commands to it. One thread. */
#ifndef SEND_ROBOT_LINK_H
#define SEND_ROBOT_LINK_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ale/status_t.hpp"
#include "common/feed/lcm_feed.h"

extern "C" {
#include "command/operator.h"
#include "command/verify.h"
#include "lcm/bus.h"
}

namespace send
{

class RobotLink
{
  public:
    /* robot empty: the first one that is heard. Throws std::runtime_error when LCM cannot be joined. */
    RobotLink(const std::string &url, const std::string &robot, const ale_secret_key_t &key);

    /* Listens until the condition holds, or the time is over: then false. */
    bool wait(int timeout_ms, const std::function<bool()> &condition);

    /* Completes, signs and sends; the command's counter. Throws when there is no robot yet or LCM refuses. */
    int64_t command(ale_command_t command, int64_t life_us);

    const std::optional<ale::status_t> &status() const
    {
        return status_;
    }

    /* The newest status answers the command of this counter, or a later one. */
    bool answered(int64_t counter) const;

  private:
    void take(const ale::status_t &status);

    std::string robot_;
    ale_operator_t operator_{};
    std::optional<ale::status_t> status_;
    feed::LcmFeed feed_;
    std::unique_ptr<ale_bus_t, decltype(&ale_bus_close)> bus_{nullptr, ale_bus_close};
};

} // namespace send

#endif
