/* asm/termbits.h declares struct termios2 and excludes <termios.h>: hence a file of its own. */
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "serial/port_backend.h"

int ale_port_set_any_baud(int fd, int32_t baud)
{
    struct termios2 settings;
    if (baud <= 0 || ioctl(fd, TCGETS2, &settings) < 0) {
        return ALE_PORT_BAUD;
    }
    settings.c_cflag &= ~(tcflag_t)(CBAUD | (CBAUD << IBSHIFT));
    settings.c_cflag |= BOTHER | (BOTHER << IBSHIFT);
    settings.c_ispeed = (speed_t)baud;
    settings.c_ospeed = (speed_t)baud;
    return ioctl(fd, TCSETS2, &settings) < 0 ? ALE_PORT_BAUD : 0;
}
