/* One robot of the console: what is heard of it, and what its pages see, ask and command.
 *
 *   Robot robot({"rover1", lcm_url, ...});    (throws std::runtime_error)
 *   robot.follow(stopping);                   (its LCM thread, until then)
 *
 * board() and commander() are for any thread, desk() for the web thread. Nothing is shared between robots. */
#ifndef CONSOLE_ROBOT_H
#define CONSOLE_ROBOT_H

#include <atomic>
#include <string>

#include "common/feed/lcm_feed.h"
#include "operator/console/board.h"
#include "operator/console/commander.h"
#include "operator/console/recordings/archive.h"
#include "operator/console/recordings/desk.h"
#include "operator/console/recordings/recorder.h"
#include "operator/console/recordings/shelf.h"
#include "operator/console/robot_watch.h"

namespace console
{

/* Empty folders: there are none. */
struct RobotSettings {
    std::string name; /* by which pages ask for it */
    Credentials credentials;
    std::string recordings;
    std::string flights;
    std::string maps;
};

class Robot
{
  public:
    explicit Robot(const RobotSettings &settings);
    Robot(const Robot &) = delete;
    Robot &operator=(const Robot &) = delete;

    /* Hears it. Throws std::runtime_error when its messages can no longer be received. */
    void follow(const std::atomic<bool> &stopping);

    const std::string &name() const
    {
        return name_;
    }
    Board &board()
    {
        return board_;
    }
    const Board &board() const
    {
        return board_;
    }
    Commander &commander()
    {
        return commander_;
    }
    Desk &desk()
    {
        return desk_;
    }

  private:
    void record(const char *channel, bool whoever_speaks);

    std::string name_;
    Board board_;
    feed::LcmFeed feed_;
    Commander commander_;
    RobotWatch watch_;
    Archive::Shelves shelves_;
    Recorder recorder_;
    Archive archive_;
    Desk desk_;
};

} // namespace console

#endif
