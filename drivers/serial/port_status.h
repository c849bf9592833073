/* How a call on a serial port ended. */
#ifndef ALE_SERIAL_PORT_STATUS_H
#define ALE_SERIAL_PORT_STATUS_H

typedef enum {
    ALE_PORT_OK = 0,
    ALE_PORT_GONE = -1,       /* unplugged, hung up, I/O error */
    ALE_PORT_DENIED = -2,     /* no permission */
    ALE_PORT_ABSENT = -3,     /* no such device */
    ALE_PORT_BAUD = -4,       /* rate not possible on this port */
    ALE_PORT_TIMEOUT = -5,    /* the port takes no bytes */
    ALE_PORT_FILE = -6,       /* the path is an ordinary file, */
    ALE_PORT_FOLDER = -7,     /* a directory, */
    ALE_PORT_OTHER = -8,      /* or something else that is no terminal */
    ALE_PORT_BUSY = -9,       /* another program holds it */
    ALE_PORT_ADDRESS = -10,   /* of tcp: no address and port, */
    ALE_PORT_REFUSED = -11,   /* nobody listens there, */
    ALE_PORT_UNREACHED = -12, /* no way leads there, */
    ALE_PORT_UNANSWERED = -13 /* or nobody is there */
} ale_port_status_t;

/* The status that an errno of open, read or write stands for. */
ale_port_status_t ale_port_status_of_errno(int error);

/* A status in plain words, one line. Static text. */
const char *ale_port_strerror(int status);

#endif
