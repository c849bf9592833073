/* Commands for the robot, signed with the bridge's key.
 *
 *   Commander commander({lcm_url, "alice.key", "", ""});   (throws std::runtime_error; no file: all is
 * refused) commander.saw(status); commander.saw_vouched(bytes, count); refusal = commander.send({"drive",
 * "0.2", "0"});       empty: it is on its way answer = commander.new_answer();                       what the
 * robot said to the last one, once
 *
 * One thread. */
#ifndef ROS2_COMMANDER_H
#define ROS2_COMMANDER_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/command/operators_end.h"

namespace ros2
{

/* Where the robot is, and with whose keys. Empty: none. */
struct Credentials {
    std::string lcm_url;
    std::string key_file;
    std::string robots_file; /* empty: the one beside the key */
    std::string robot;       /* empty: the one that is heard */
};

struct Answer {
    bool obeyed;
    std::string words;
};

class Commander
{
  public:
    explicit Commander(const Credentials &credentials);

    bool has_key() const
    {
        return end_.has_key();
    }
    bool believes() const
    {
        return end_.believes();
    }

    /* Whether it is the status of the robot that is meant. */
    bool saw(const ale::status_t &status);
    /* Nothing: no robot that is believed has signed it, or it is not new. */
    std::optional<ale::status_t> saw_vouched(const uint8_t *bytes, size_t count);

    std::string send(const std::vector<std::string> &words);

    std::optional<Answer> new_answer();

  private:
    void note_answer(const ale::status_t &status);
    std::string doubt() const;

    command::OperatorsEnd end_;
    int64_t last_ = 0; /* number of the last command */
    int64_t answered_ = 0;
    std::optional<Answer> answer_;
};

} // namespace ros2

#endif
