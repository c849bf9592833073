/* One robot as an operator's program sees it: its newest status, and commands to it. One thread. */
#ifndef SEND_ROBOT_LINK_H
#define SEND_ROBOT_LINK_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ale/status_t.hpp"
#include "common/feed/lcm_feed.h"
#include "common/feed/vouched.h"

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
    /* robot empty: the one that is heard. robots: that are believed; none: every one. Throws
     * std::runtime_error when LCM cannot be joined. */
    RobotLink(const std::string &url, const std::string &robot, const ale_secret_key_t &key,
              const ale_keys_t &robots);

    /* Listens until the condition holds, or the time is over: then false. */
    bool wait(int timeout_ms, const std::function<bool()> &condition);

    /* Completes, signs and sends. A stop goes to every start of the robot that was heard lately. Throws when
     * there is no robot yet or LCM refuses. */
    void command(ale_command_t command, int64_t life_us);

    /* The last command was made by the word of an earlier start, or of an earlier hour, which somebody has
     * played again: no robot can obey it, or it was a stop. */
    bool was_misled() const;

    /* What the robot says is signed with a key that is believed. */
    bool is_vouched() const
    {
        return operator_.robots.count > 0;
    }

    /* Another robot that is heard beside this one; empty: none. */
    std::string rival() const;

    /* A status that nobody vouches for, while only robots are believed that vouch for theirs. */
    const std::optional<ale::status_t> &unbelieved() const
    {
        return unbelieved_;
    }

    const std::optional<ale::status_t> &status() const
    {
        return status_;
    }

    /* The newest status answers a command that was sent from here, and no other one. */
    bool answered() const;

    /* This operator has gone on driving since the last command, from here or with another program. */
    bool drives_since() const;

  private:
    void take(const ale::status_t &status);
    void take_vouched(const uint8_t *bytes, size_t count);
    void send(const uint8_t *bytes, size_t count);

    std::optional<ale::status_t> unbelieved_;
    std::vector<int64_t> counters_; /* of commands that were sent */
    ale_command_t last_{};
    int64_t last_host_us_ = 0;
    ale_operator_t operator_{};
    std::optional<ale::status_t> status_;
    feed::LcmFeed feed_;
    std::unique_ptr<ale_bus_t, decltype(&ale_bus_close)> bus_{nullptr, ale_bus_close};
};

} // namespace send

#endif
