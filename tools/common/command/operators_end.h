/* An operator's end of LCM in a program: whom he hears, and commands that are signed and sent. What it knows
 * of robots and their starts: drivers/command/operator.h.
 *
 *   command::OperatorsEnd end(robots, wanted);        (he only listens)
 *   end.take_key(url, key);                           (from now on he may command)
 *   if (end.saw(status)) ...                          (every ALE_STATUS, and every ALE_VOUCHED that
 *                                                      feed::vouched_by knows)
 *   end.send(command, life_us);
 *   if (end.was_misled(made)) ...                     (from time to time after a command that matters)
 *
 * One caller at a time. */
#ifndef ALE_COMMON_COMMAND_OPERATORS_END_H
#define ALE_COMMON_COMMAND_OPERATORS_END_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ale/status_t.hpp"
#include "ale/vouched_t.hpp"

extern "C" {
#include "command/operator.h"
#include "lcm/bus.h"
}

namespace command
{

class OperatorsEnd
{
  public:
    /* robots: that are believed; none: every one. wanted: the robot's name; empty: the one that is heard. */
    OperatorsEnd(const ale_keys_t &robots, const std::string &wanted);

    /* Throws std::runtime_error when LCM cannot be joined. */
    void take_key(const std::string &url, const ale_secret_key_t &key);

    bool has_key() const
    {
        return bus_ != nullptr;
    }
    /* Empty: there is no key. */
    std::string name() const
    {
        return end_.key.name;
    }

    /* Whether it is the robot that was asked for by name. */
    bool wants(const std::string &robot) const
    {
        return end_.wanted[0] != '\0' && robot == end_.wanted;
    }

    /* Whether only what robots vouch for is believed, and which they are. */
    bool believes() const
    {
        return end_.robots.count > 0;
    }
    const ale_keys_t &robots() const
    {
        return end_.robots;
    }

    /* Whether it is of his robot, and new. */
    bool saw(const ale::status_t &status);
    bool saw(const ale::vouched_t &message);

    /* The robot that commands are for; empty: none was heard yet. */
    std::string robot() const
    {
        return end_.present.robot;
    }

    /* Another one that is heard beside it, of its own name even; empty: none. */
    std::string rival() const;

    /* The names of all that are heard, each once, and the one that commands are for first. */
    std::vector<std::string> heard() const;

    /* Completes, signs and sends. A stop goes to every start of every robot that was heard lately, of the one
     * that is wanted where one is. The numbers of what was sent, the one for robot() first; none: no robot
     * was heard yet, or a word is too long. Throws std::runtime_error when LCM does not take it. */
    std::vector<int64_t> send(const ale_command_t &command, int64_t life_us);

    /* Of the last command that was sent. */
    ale_made_t made() const
    {
        return end_.made;
    }

    /* ale_operator_was_misled. */
    bool was_misled(const ale_made_t &made) const;

  private:
    void publish(const uint8_t *bytes, size_t count);

    ale_operator_t end_{};
    std::unique_ptr<ale_bus_t, decltype(&ale_bus_close)> bus_{nullptr, ale_bus_close};
};

} // namespace command

#endif
