/* The robots of one console: which they are by its options, how each of them is, and STOP for all of them.
 *
 *   Fleet fleet(settings_of(options));        (throws std::runtime_error)
 *   Robot *robot = fleet.find("rover1");
 *
 * Web thread, but for the robots' own. */
#ifndef CONSOLE_FLEET_H
#define CONSOLE_FLEET_H

#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "operator/console/commander.h"
#include "operator/console/messages.h"
#include "operator/console/robot.h"

namespace console
{

/* A robot for each lcm_url, and one where there is none. The other lists are empty, or have a word for each
 * robot, in the same order. */
struct FleetOptions {
    std::vector<std::string> lcm_urls;
    std::vector<std::string> robots; /* names that they have themselves */
    std::vector<std::string> recordings;
    std::vector<std::string> flights;
    std::vector<std::string> maps;
    std::string key_file;
    std::string robots_file;
};

/* Each robot is called by the name it has in `robots`, else by the prefix of its channels ("rover1" of
 * "rover1."), else by the group that it speaks in. Throws cli::WrongUse where options do not belong together
 * and two robots cannot be told apart, std::runtime_error for a URL that is none. */
std::vector<RobotSettings> settings_of(const FleetOptions &options);

class Fleet
{
  public:
    /* At least one. */
    explicit Fleet(const std::vector<RobotSettings> &settings);

    /* wake: called by any thread when there is something new for pages. To be closed before what it wakes is
     * gone. */
    void open(const std::function<void()> &wake);
    void close();

    /* Empty: the first one. nullptr: there is none of that name. */
    Robot *find(std::string_view name);

    std::list<Robot> &robots()
    {
        return robots_;
    }

    std::vector<RobotTold> told() const;

    /* For a page that shows `shown`: the number is of the command to that one, the refusal says which robots
     * it did not go to, and why. */
    Sent stop_all(uint64_t page, const Robot &shown);

  private:
    std::list<Robot> robots_;
};

} // namespace console

#endif
