#include "serial/port_status.h"

#include <errno.h>
#include <stddef.h>

typedef struct {
    int error;
    ale_port_status_t status;
} meaning_t;

static const meaning_t MEANINGS[] = {
    {EACCES, ALE_PORT_DENIED},
    {EPERM, ALE_PORT_DENIED},
    {EBUSY, ALE_PORT_BUSY},
    {EWOULDBLOCK, ALE_PORT_BUSY},
    {ENOENT, ALE_PORT_ABSENT},
    {ENODEV, ALE_PORT_ABSENT},
    {ENXIO, ALE_PORT_ABSENT},
    {ENOTDIR, ALE_PORT_ABSENT},
    {EISDIR, ALE_PORT_ABSENT},
    {ELOOP, ALE_PORT_ABSENT},
    {ENOTTY, ALE_PORT_OTHER},
    {ECONNREFUSED, ALE_PORT_REFUSED},
    {EHOSTUNREACH, ALE_PORT_UNREACHED},
    {ENETUNREACH, ALE_PORT_UNREACHED},
    {ENETDOWN, ALE_PORT_UNREACHED},
    {EADDRNOTAVAIL, ALE_PORT_UNREACHED},
    {ETIMEDOUT, ALE_PORT_UNANSWERED},
};

ale_port_status_t ale_port_status_of_errno(int error)
{
    for (size_t k = 0; k < sizeof MEANINGS / sizeof MEANINGS[0]; k++) {
        if (MEANINGS[k].error == error) {
            return MEANINGS[k].status;
        }
    }
    return ALE_PORT_GONE;
}

/* By the negative of the status. */
static const char *const WORDS[] = {
    [ALE_PORT_OK] = "no error",
    [-ALE_PORT_GONE] = "the port is gone (unplugged or hung up)",
    [-ALE_PORT_DENIED] = "no access: permission is missing (group dialout)",
    [-ALE_PORT_BUSY] = "in use by another program",
    [-ALE_PORT_ABSENT] = "no such serial device",
    [-ALE_PORT_FILE] = "is an ordinary file and no serial device (ale-sim --log plays a recording)",
    [-ALE_PORT_FOLDER] = "is a directory and no serial device",
    [-ALE_PORT_OTHER] = "is no serial device",
    [-ALE_PORT_BAUD] = "the port cannot do this baud rate",
    [-ALE_PORT_TIMEOUT] = "the port takes no bytes",
    [-ALE_PORT_ADDRESS] = "no numeric address and port, as in tcp:192.168.0.10:10940",
    [-ALE_PORT_REFUSED] = "connection refused: a computer is there, but nobody listens at this port",
    [-ALE_PORT_UNREACHED] =
        "no way there: is the cable in, and an address of its network set on this computer?",
    [-ALE_PORT_UNANSWERED] = "nobody answers at this address: is it right, and the scanner supplied?",
};

const char *ale_port_strerror(int status)
{
    const int count = sizeof WORDS / sizeof WORDS[0];
    return status <= 0 && status > -count ? WORDS[-status] : "unknown status";
}
