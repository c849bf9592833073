#include <errno.h>
#include <libserialport.h>

#include "serial/port_backend.h"

static int status_of(enum sp_return result)
{
    switch (result) {
    case SP_ERR_ARG:
        return ALE_PORT_ABSENT;
    case SP_ERR_FAIL:
        return ale_port_status_of_errno(sp_last_error_code());
    default:
        return result < 0 ? ALE_PORT_GONE : ALE_PORT_OK;
    }
}

static int set_baud(struct sp_port *handle, int fd, int32_t baud)
{
    return sp_set_baudrate(handle, baud) == SP_OK ? ALE_PORT_OK : ale_port_set_any_baud(fd, baud);
}

/* DTR and RTS stay as the kernel left them: on some boards they reset what hangs on the line. */
static int configure(ale_port_t *port, struct sp_port *handle, int32_t baud)
{
    enum sp_return result = sp_get_port_handle(handle, &port->fd);
    result = result < 0 ? result : sp_set_bits(handle, 8);
    result = result < 0 ? result : sp_set_parity(handle, SP_PARITY_NONE);
    result = result < 0 ? result : sp_set_stopbits(handle, 1);
    result = result < 0 ? result : sp_set_cts(handle, SP_CTS_IGNORE);
    result = result < 0 ? result : sp_set_dsr(handle, SP_DSR_IGNORE);
    result = result < 0 ? result : sp_set_xon_xoff(handle, SP_XONXOFF_DISABLED);
    if (result < 0) {
        return status_of(result);
    }
    const int status = set_baud(handle, port->fd, baud);
    sp_flush(handle, SP_BUF_BOTH);
    return status;
}

static int sp_backend_open(ale_port_t *port, const char *real_path, int32_t baud)
{
    struct sp_port *handle = NULL;
    enum sp_return result = sp_get_port_by_name(real_path, &handle);
    if (result < 0) {
        return status_of(result);
    }
    result = sp_open(handle, SP_MODE_READ_WRITE);
    if (result < 0) {
        const int status = status_of(result);
        sp_free_port(handle);
        return status;
    }
    const int status = configure(port, handle, baud);
    if (status < 0) {
        sp_close(handle);
        sp_free_port(handle);
        return status;
    }
    port->handle = handle;
    return ALE_PORT_OK;
}

static int sp_backend_set_baud(ale_port_t *port, int32_t baud)
{
    return set_baud(port->handle, port->fd, baud);
}

static int moved(enum sp_return result)
{
    if (result >= 0) {
        return (int)result;
    }
    const bool interrupted = result == SP_ERR_FAIL && sp_last_error_code() == EINTR;
    return interrupted ? 0 : status_of(result);
}

static int sp_backend_read(ale_port_t *port, uint8_t *bytes, size_t capacity)
{
    return moved(sp_nonblocking_read(port->handle, bytes, capacity));
}

static int sp_backend_write(ale_port_t *port, const uint8_t *bytes, size_t count)
{
    return moved(sp_nonblocking_write(port->handle, bytes, count));
}

static void sp_backend_close(ale_port_t *port)
{
    sp_close(port->handle);
    sp_free_port(port->handle);
}

const ale_port_backend_t ale_port_libserialport_backend = {.open = sp_backend_open,
                                                           .set_baud = sp_backend_set_baud,
                                                           .read = sp_backend_read,
                                                           .write = sp_backend_write,
                                                           .close = sp_backend_close};
