#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "include/rtai_serial.h"
#include "internal.h"

enum { PORTS = 2, BUFFER_BYTES = 512, FASTEST = 115200 };

static int descriptors[PORTS] = {-1, -1};

static int open_terminal(unsigned tty)
{
    char name[20];
    snprintf(name, sizeof name, "ALE_RTAI_TTY%u", tty);
    const char *path = getenv(name);
    const int descriptor = path ? open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC) : -1;
    struct termios settings;
    if (descriptor >= 0 && tcgetattr(descriptor, &settings) == 0) {
        cfmakeraw(&settings);
        tcsetattr(descriptor, TCSANOW, &settings);
    }
    return descriptor;
}

int rt_spopen(unsigned int tty, unsigned int baud, unsigned int numbits, unsigned int stopbits,
              unsigned int parity, int mode, int fifotrig)
{
    (void)parity;
    (void)mode;
    (void)fifotrig;
    if (tty >= PORTS) {
        return -ENODEV;
    }
    if (baud < 50 || FASTEST % baud != 0 || numbits != 8 || stopbits != 1) {
        return -EINVAL;
    }
    if (descriptors[tty] >= 0) {
        return -EADDRINUSE;
    }
    rtai_enter();
    descriptors[tty] = open_terminal(tty);
    rtai_leave();
    return descriptors[tty] >= 0 ? 0 : -ENODEV;
}

int rt_spclose(unsigned int tty)
{
    if (tty >= PORTS || descriptors[tty] < 0) {
        return -ENODEV;
    }
    rtai_enter();
    close(descriptors[tty]);
    descriptors[tty] = -1;
    rtai_leave();
    return 0;
}

static bool is_open(unsigned tty)
{
    return tty < PORTS && descriptors[tty] >= 0;
}

int rt_spget_rxavbs(unsigned int tty)
{
    int available = 0;
    rtai_enter();
    const bool known = is_open(tty) && ioctl(descriptors[tty], FIONREAD, &available) == 0;
    rtai_leave();
    return known ? available : -ENODEV;
}

int rt_spget_txfrbs(unsigned int tty)
{
    return is_open(tty) ? BUFFER_BYTES : -ENODEV;
}

int rt_spread(unsigned int tty, char *message, int size)
{
    const int wanted = abs(size);
    if (!is_open(tty) || (size < 0 && rt_spget_rxavbs(tty) < wanted)) {
        return is_open(tty) ? wanted : -ENODEV;
    }
    rtai_enter();
    const ssize_t count = read(descriptors[tty], message, (size_t)wanted);
    rtai_leave();
    return wanted - (count > 0 ? (int)count : 0);
}

int rt_spwrite(unsigned int tty, char *message, int size)
{
    const int wanted = abs(size);
    if (!is_open(tty)) {
        return -ENODEV;
    }
    rtai_enter();
    const ssize_t count = write(descriptors[tty], message, (size_t)wanted);
    rtai_leave();
    return wanted - (count > 0 ? (int)count : 0);
}
