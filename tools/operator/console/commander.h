/* What pages ask for, signed with the operator's key and sent to the robot.
 *
 *   Commander commander(lcm_url, "alice.key");      (throws std::runtime_error; no file: nobody commands
 * here) commander.saw(status);                          (LCM thread, every ALE_STATUS) sent =
 * commander.send(page, {"drive", "0.2", "0"});                                      (web thread)
 *
 * Every page of one console has the same operator's key, so who of them drives is settled here: the first one
 * that does, until it has not for two seconds. */
#ifndef CONSOLE_COMMANDER_H
#define CONSOLE_COMMANDER_H

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ale/status_t.hpp"

extern "C" {
#include "command/operator.h"
#include "lcm/bus.h"
}

namespace console
{

/* What became of a page's wish: the command's number, or why it was not sent. */
struct Sent {
    int64_t number = 0;
    std::string refusal;
};

class Commander
{
  public:
    using Clock = std::chrono::steady_clock;

    Commander(const std::string &lcm_url, const std::string &key_file);

    /* Empty: there is no key. */
    std::string operator_name() const
    {
        return operator_.key.name;
    }

    void saw(const ale::status_t &status);

    /* page: any number that tells the pages apart. */
    Sent send(uint64_t page, const std::vector<std::string> &words);

  private:
    bool may_drive(uint64_t page, Clock::time_point now);
    Sent sign_and_send(const std::vector<std::string> &words);

    std::mutex mutex_;
    ale_operator_t operator_{};
    std::unique_ptr<ale_bus_t, decltype(&ale_bus_close)> bus_{nullptr, ale_bus_close};
    uint64_t driving_page_ = 0;
    Clock::time_point drove_at_{};
};

} // namespace console

#endif
