/* asm/termbits.h declares struct termios2 and excludes <termios.h>: hence a file of its own. */
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "lab/sim/line/pty.h"

namespace sim
{

int32_t Pty::rate() const
{
    struct termios2 mode = {};
    return plugged() && ioctl(master_, TCGETS2, &mode) == 0 ? static_cast<int32_t>(mode.c_ospeed) : 0;
}

} // namespace sim
