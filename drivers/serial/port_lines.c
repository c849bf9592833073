#include <sys/ioctl.h>

#include "serial/port.h"
#include "serial/port_backend.h"

int ale_port_set_dtr(ale_port_t *port, bool on)
{
    const int lines = TIOCM_DTR;
    return ioctl(port->fd, on ? TIOCMBIS : TIOCMBIC, &lines) < 0 ? ALE_PORT_OTHER : ALE_PORT_OK;
}
