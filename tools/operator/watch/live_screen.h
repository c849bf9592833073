/* The text screen on a terminal, with the keys of its operator. */
#ifndef WATCH_LIVE_SCREEN_H
#define WATCH_LIVE_SCREEN_H

#include <string>

#include "operator/watch/terminal.h"

namespace watch
{

class LiveScreen
{
  public:
    /* Shows the state of now and takes a key. False: the operator has seen enough. */
    bool show(const RobotState &state);

  private:
    bool take_key();

    Terminal terminal_;
    View view_;
};

/* One screen as text, for what is no terminal. */
std::string printed_screen(const RobotState &state);

} // namespace watch

#endif
