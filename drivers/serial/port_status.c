#include "serial/port_status.h"

#include <errno.h>

ale_port_status_t ale_port_status_of_errno(int error)
{
    switch (error) {
    case EACCES:
    case EPERM:
        return ALE_PORT_DENIED;
    case EBUSY:
    case EWOULDBLOCK:
        return ALE_PORT_BUSY;
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case ENOTDIR:
    case EISDIR:
    case ELOOP:
        return ALE_PORT_ABSENT;
    case ENOTTY:
        return ALE_PORT_OTHER;
    default:
        return ALE_PORT_GONE;
    }
}

const char *ale_port_strerror(int status)
{
    switch (status) {
    case ALE_PORT_OK:
        return "no error";
    case ALE_PORT_GONE:
        return "the port is gone (unplugged or hung up)";
    case ALE_PORT_DENIED:
        return "no access: permission is missing (group dialout)";
    case ALE_PORT_BUSY:
        return "in use by another program";
    case ALE_PORT_ABSENT:
        return "no such serial device";
    case ALE_PORT_FILE:
        return "is an ordinary file and no serial device (ale-sim --log plays a recording)";
    case ALE_PORT_FOLDER:
        return "is a directory and no serial device";
    case ALE_PORT_OTHER:
        return "is no serial device";
    case ALE_PORT_BAUD:
        return "the port cannot do this baud rate";
    case ALE_PORT_TIMEOUT:
        return "the port takes no bytes";
    default:
        return "unknown status";
    }
}
