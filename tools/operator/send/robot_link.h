/* One robot as an operator's program sees it: its newest status, and commands to it. One thread. */
#ifndef SEND_ROBOT_LINK_H
#define SEND_ROBOT_LINK_H

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ale/status_t.hpp"
#include "common/command/operators_end.h"
#include "common/feed/lcm_feed.h"

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

    /* Completes, signs and sends; a stop to all that are heard. Throws when there is no robot yet or LCM
     * refuses. */
    void command(const ale_command_t &command, int64_t life_us);

    /* The last command did not reach whom it was for (ale_operator_was_misled): it should be made again. */
    bool was_misled() const;

    /* What the robot says is signed with a key that is believed. */
    bool is_vouched() const
    {
        return end_.believes();
    }

    /* Another robot that is heard beside this one; empty: none. */
    std::string rival() const
    {
        return end_.rival();
    }

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

    /* What robots have answered to commands from here, by their names; who is heard and has not. */
    const std::map<std::string, ale::status_t> &answers() const
    {
        return answers_;
    }
    std::vector<std::string> unanswered() const;

    /* This operator has gone on driving since the last command, from here or with another program. */
    bool drives_since() const;

  private:
    void take(const ale::status_t &status);
    void take_vouched(const uint8_t *bytes, size_t count);
    bool answers(const ale::status_t &status) const;
    void note_answer(const ale::status_t &status);

    std::string wanted_;
    std::vector<int64_t> numbers_; /* of commands that were sent */
    int64_t last_ = 0;             /* of the last one */
    std::map<std::string, ale::status_t> answers_;
    std::optional<ale::status_t> unbelieved_;
    std::optional<ale::status_t> status_;
    command::OperatorsEnd end_;
    feed::LcmFeed feed_;
};

} // namespace send

#endif
