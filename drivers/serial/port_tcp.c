/* A scanner on Ethernet: its bytes over a TCP connection. Addresses are numeric: looking a name up may take
 * minutes. */
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "serial/port_backend.h"

enum { HOST_BYTES = 64, CONNECT_MS = 1000, LOST_MS = 2000, IDLE_S = 1, PROBES = 2 };

static const char usual_port[] = "10940"; /* Hokuyo's */

/* "192.168.0.10:10940", "192.168.0.10", "[fe80::1]:10940". */
static int resolve(const char *text, struct addrinfo **found)
{
    char host[HOST_BYTES];
    const bool bracketed = text[0] == '[';
    const size_t length = strcspn(text + bracketed, bracketed ? "]" : ":");
    const char *rest = text + bracketed + length;
    const bool closed = !bracketed || *rest == ']';
    rest += bracketed && closed;
    if (!closed || length == 0 || length >= sizeof host || (*rest != '\0' && *rest != ':')) {
        return ALE_PORT_ADDRESS;
    }
    memcpy(host, text + bracketed, length);
    host[length] = '\0';
    const struct addrinfo wanted = {
        .ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM, .ai_flags = AI_NUMERICHOST | AI_NUMERICSERV};
    const char *port = *rest == ':' ? rest + 1 : usual_port;
    return getaddrinfo(host, port, &wanted, found) == 0 ? ALE_PORT_OK : ALE_PORT_ADDRESS;
}

/* A connection whose cable was pulled is given up, also by a kernel that waits for bytes to be acknowledged.
 */
static void set_options(int fd)
{
    const int yes = 1;
    const int lost_ms = LOST_MS;
    const int idle_s = IDLE_S;
    const int probes = PROBES;
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    (void)setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
    (void)setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
    (void)setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &idle_s, sizeof idle_s);
    (void)setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof probes);
    (void)setsockopt(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, &lost_ms, sizeof lost_ms);
}

/* What became of a connection that was begun. */
static int finish(int fd)
{
    struct pollfd wait = {.fd = fd, .events = POLLOUT};
    int ready;
    do {
        ready = poll(&wait, 1, CONNECT_MS);
    } while (ready < 0 && errno == EINTR);
    if (ready <= 0) {
        return ALE_PORT_UNANSWERED;
    }
    int error = 0;
    socklen_t size = sizeof error;
    (void)getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    return error == 0 ? ALE_PORT_OK : (int)ale_port_status_of_errno(error);
}

static int connect_to(const struct addrinfo *address, int *fd)
{
    *fd = socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (*fd < 0) {
        return ale_port_status_of_errno(errno);
    }
    set_options(*fd);
    int status = ALE_PORT_OK;
    if (connect(*fd, address->ai_addr, address->ai_addrlen) < 0) {
        status = errno == EINPROGRESS ? finish(*fd) : (int)ale_port_status_of_errno(errno);
    }
    if (status < 0) {
        close(*fd);
    }
    return status;
}

static int tcp_open(ale_port_t *port, const char *address, int32_t baud)
{
    (void)baud;
    struct addrinfo *found = NULL;
    int status = resolve(address, &found);
    if (status == ALE_PORT_OK) {
        status = connect_to(found, &port->fd);
        freeaddrinfo(found);
    }
    return status;
}

static int tcp_set_baud(ale_port_t *port, int32_t baud)
{
    (void)port;
    (void)baud;
    return ALE_PORT_BAUD;
}

static int failure(void)
{
    return errno == EAGAIN || errno == EINTR ? 0 : ALE_PORT_GONE;
}

/* The other side's end of the connection reads as no bytes. */
static int tcp_read(ale_port_t *port, uint8_t *bytes, size_t capacity)
{
    const ssize_t count = recv(port->fd, bytes, capacity, 0);
    if (count == 0 && capacity > 0) {
        return ALE_PORT_GONE;
    }
    return count < 0 ? failure() : (int)count;
}

static int tcp_write(ale_port_t *port, const uint8_t *bytes, size_t count)
{
    const ssize_t written = send(port->fd, bytes, count, MSG_NOSIGNAL);
    return written < 0 ? failure() : (int)written;
}

static void tcp_close(ale_port_t *port)
{
    close(port->fd);
}

const ale_port_backend_t ale_port_tcp_backend = {
    .open = tcp_open, .set_baud = tcp_set_baud, .read = tcp_read, .write = tcp_write, .close = tcp_close};
