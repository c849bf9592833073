/* What pages ask for, signed with the operator's key and sent to the robot.
 *
 *   Commander commander({lcm_url, "alice.key"});     (throws std::runtime_error; no file: nobody commands)
 *   if (commander.saw(status)) ...                   (LCM thread, every ALE_STATUS)
 *   status = commander.saw_vouched(bytes, count);    (LCM thread, every ALE_VOUCHED)
 *   commander.keep_stopped();                        (LCM thread, after messages and ten times a second)
 *   sent = commander.send(page, {"drive", "0.2", "0"});                  (web thread)
 *
 * With robots that are believed only what they vouch for is true; nothing is signed for another one.
 * Every page of one console has the same operator's key, so who of them drives is settled here: the first one
 * that does, until it has not for two seconds. */
#ifndef CONSOLE_COMMANDER_H
#define CONSOLE_COMMANDER_H

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/command/operators_end.h"

namespace console
{

/* Where the robot is, and with whose keys. Empty: none. */
struct Credentials {
    std::string lcm_url;
    std::string key_file;
    std::string robots_file; /* empty: the one beside the key */
    std::string robot;       /* empty: the one that is heard */
};

/* What became of a page's wish: the command's number, or why it was not sent. */
struct Sent {
    int64_t number = 0;
    std::string refusal;
};

class Commander
{
  public:
    using Clock = std::chrono::steady_clock;

    explicit Commander(const Credentials &credentials);

    /* Empty: there is no key. */
    std::string operator_name() const
    {
        return end_.name();
    }

    /* Whether only what robots vouch for is believed. */
    bool believes() const
    {
        return end_.believes();
    }

    /* Whether it is the one that was asked for by name. */
    bool wants(const std::string &robot) const
    {
        return end_.wants(robot);
    }

    /* Whether it is to be shown as the robot's: of this robot, and nobody has vouched for another one. */
    bool saw(const ale::status_t &status);

    /* Nothing: no robot that is believed has signed it, it is of another one, or it was heard before. */
    std::optional<ale::vouched_t> saw_vouched(const uint8_t *bytes, size_t count);

    /* A stop of the last two seconds that did not reach whom it was for (ale_operator_was_misled) is made
     * again, whatever was driven since. */
    void keep_stopped();

    /* What an operator must know of whom he hears, a line each. */
    std::vector<std::string> warnings();

    /* page: any number that tells the pages apart. */
    Sent send(uint64_t page, const std::vector<std::string> &words);

  private:
    bool may_drive(uint64_t page, Clock::time_point now);
    Sent sign_and_send(const std::vector<std::string> &words);
    std::string doubt() const;

    std::mutex mutex_;
    command::OperatorsEnd end_;
    uint64_t driving_page_ = 0;
    Clock::time_point drove_at_{};
    Clock::time_point stopped_at_{}; /* by a page */
    ale_made_t stop_{};              /* the last one that was sent */
    std::string unbelieved_;         /* a robot that is heard, and that nobody vouches for */
};

} // namespace console

#endif
