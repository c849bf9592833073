#include <errno.h>
#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include "serial/port_backend.h"

static int configure(int fd, int32_t baud)
{
    struct termios settings;
    if (tcgetattr(fd, &settings) < 0) {
        return ale_port_status_of_errno(errno);
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~(tcflag_t)(CRTSCTS | CSTOPB | HUPCL);
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    if (tcsetattr(fd, TCSANOW, &settings) < 0) {
        return ale_port_status_of_errno(errno);
    }
    return ale_port_set_any_baud(fd, baud);
}

static int fd_open(ale_port_t *port, const char *real_path, int32_t baud)
{
    do {
        port->fd = open(real_path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    } while (port->fd < 0 && errno == EINTR);
    if (port->fd < 0) {
        return ale_port_status_of_errno(errno);
    }
    const int status = configure(port->fd, baud);
    if (status < 0) {
        close(port->fd);
        return status;
    }
    tcflush(port->fd, TCIOFLUSH);
    return ALE_PORT_OK;
}

static int fd_set_baud(ale_port_t *port, int32_t baud)
{
    return ale_port_set_any_baud(port->fd, baud);
}

static int moved(ssize_t count)
{
    if (count >= 0) {
        return (int)count;
    }
    return errno == EAGAIN ? 0 : ale_port_status_of_errno(errno);
}

static int fd_read(ale_port_t *port, uint8_t *bytes, size_t capacity)
{
    ssize_t count;
    do {
        count = read(port->fd, bytes, capacity);
    } while (count < 0 && errno == EINTR);
    return moved(count);
}

static int fd_write(ale_port_t *port, const uint8_t *bytes, size_t count)
{
    ssize_t written;
    do {
        written = write(port->fd, bytes, count);
    } while (written < 0 && errno == EINTR);
    return moved(written);
}

static void fd_close(ale_port_t *port)
{
    close(port->fd);
}

const ale_port_backend_t ale_port_fd_backend = {
    .open = fd_open, .set_baud = fd_set_baud, .read = fd_read, .write = fd_write, .close = fd_close};
