#include "serial/port.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "serial/port_backend.h"

enum { NAME_BYTES = 32 };

/* libserialport serves what the kernel lists as a terminal; it refuses pseudo terminals. */
static bool listed_by_kernel(const char *name)
{
    char entry[PATH_MAX];
    snprintf(entry, sizeof entry, "/sys/class/tty/%s", name);
    return access(entry, F_OK) == 0;
}

/* The rate means something on ttyS and on USB adapters with a real line behind them, not on CDC-ACM. */
static bool rate_has_effect(const char *name)
{
    return strncmp(name, "ttyACM", 6) != 0;
}

/* What ale_port_offer brought. */
static struct {
    const char *prefix;
    const ale_port_backend_t *backend;
} offered;

void ale_port_offer(const char *prefix, const ale_port_backend_t *backend)
{
    offered.prefix = prefix;
    offered.backend = backend;
}

/* Such a port is no file: it locks itself. */
static int open_offered(ale_port_t *port, const char *name, int32_t baud)
{
    port->backend = offered.backend;
    port->has_baud = true;
    return port->backend->open(port, name, baud);
}

/* So is a connection; a scanner takes one at a time, and has no rate. */
static const char tcp_prefix[] = "tcp:";

static int open_connection(ale_port_t *port, const char *address)
{
    port->backend = &ale_port_tcp_backend;
    return port->backend->open(port, address, 0);
}

static struct flock whole_of_it(void)
{
    return (struct flock){.l_type = F_WRLCK, .l_whence = SEEK_SET};
}

/* Held before anything else is done to the port: what a second program sets and flushes the first would lose.
 * The record lock beside it keeps nobody out; the kernel tells by it whose process holds the port. */
static int lock(ale_port_t *port, const char *real_path)
{
    struct flock name_tag = whole_of_it();
    port->lock = open(real_path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (port->lock < 0) {
        return ale_port_status_of_errno(errno);
    }
    if (flock(port->lock, LOCK_EX | LOCK_NB) < 0) {
        close(port->lock);
        return ALE_PORT_BUSY;
    }
    (void)fcntl(port->lock, F_SETLK, &name_tag);
    return ALE_PORT_OK;
}

static int open_locked(ale_port_t *port, const char *real_path, int32_t baud)
{
    int status = lock(port, real_path);
    if (status < 0) {
        return status;
    }
    status = port->backend->open(port, real_path, baud);
    if (status < 0) {
        close(port->lock);
    }
    return status;
}

/* What else the path may be than a terminal. */
static int status_of_kind(const char *real_path)
{
    struct stat there;
    if (stat(real_path, &there) < 0) {
        return ale_port_status_of_errno(errno);
    }
    if (S_ISDIR(there.st_mode)) {
        return ALE_PORT_FOLDER;
    }
    if (S_ISREG(there.st_mode)) {
        return ALE_PORT_FILE;
    }
    return S_ISCHR(there.st_mode) ? ALE_PORT_OK : ALE_PORT_OTHER;
}

static int open_device(ale_port_t *port, const char *path, int32_t baud)
{
    char real_path[PATH_MAX];
    if (realpath(path, real_path) == NULL) {
        return ale_port_status_of_errno(errno);
    }
    const int kind = status_of_kind(real_path);
    if (kind < 0) {
        return kind;
    }
    const char *name = strrchr(real_path, '/') + 1;
    const bool real = listed_by_kernel(name);
    port->backend = real ? &ale_port_libserialport_backend : &ale_port_fd_backend;
    port->has_baud = real && rate_has_effect(name);
    return open_locked(port, real_path, baud);
}

static int open_any(ale_port_t *port, const char *path, int32_t baud)
{
    const size_t offered_prefix = offered.prefix ? strlen(offered.prefix) : 0;
    const size_t tcp = sizeof tcp_prefix - 1;
    if (offered_prefix > 0 && strncmp(path, offered.prefix, offered_prefix) == 0) {
        return open_offered(port, path + offered_prefix, baud);
    }
    return strncmp(path, tcp_prefix, tcp) == 0 ? open_connection(port, path + tcp)
                                               : open_device(port, path, baud);
}

int ale_port_open(ale_port_t **out, const char *path, int32_t baud)
{
    *out = NULL;
    ale_port_t *port = calloc(1, sizeof *port);
    if (port == NULL) {
        return ALE_PORT_GONE;
    }
    port->fd = -1;
    port->lock = -1;
    const int status = open_any(port, path, baud);
    if (status < 0) {
        free(port);
        return status;
    }
    *out = port;
    return ALE_PORT_OK;
}

int ale_port_set_baud(ale_port_t *port, int32_t baud)
{
    return port->backend->set_baud(port, baud);
}

static int64_t monotonic_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Waits for events until the deadline; the events that came, 0 at the deadline, -1 with errno. */
static int poll_until(int fd, short events, int64_t deadline_ms)
{
    for (;;) {
        struct pollfd wait = {.fd = fd, .events = events};
        const int64_t left_ms = deadline_ms - monotonic_ms();
        const int ready = poll(&wait, 1, left_ms > 0 ? (int)left_ms : 0);
        if (ready >= 0) {
            return ready > 0 ? wait.revents : 0;
        }
        if (errno != EINTR) {
            return -1;
        }
    }
}

static int wait_until(ale_port_t *port, short events, int64_t deadline_ms)
{
    if (port->backend->wait == NULL) {
        return poll_until(port->fd, events, deadline_ms);
    }
    const int64_t left_ms = deadline_ms - monotonic_ms();
    return port->backend->wait(port, events, left_ms > 0 ? (int32_t)left_ms : 0);
}

int ale_port_wait(ale_port_t *port, int32_t timeout_ms)
{
    const int64_t deadline_ms = monotonic_ms() + timeout_ms;
    if (port == NULL) {
        poll_until(-1, 0, deadline_ms);
        return 0;
    }
    const int events = wait_until(port, POLLIN, deadline_ms);
    if (events < 0 || (events & POLLNVAL) != 0) {
        return ALE_PORT_GONE;
    }
    if ((events & POLLIN) != 0) {
        return 1;
    }
    return events == 0 ? 0 : ALE_PORT_GONE;
}

/* A terminal that hung up reads as "nothing there". */
static bool hung_up(ale_port_t *port)
{
    const int events = wait_until(port, POLLIN, 0);
    return events < 0 || (events & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

int ale_port_read(ale_port_t *port, uint8_t *bytes, size_t capacity)
{
    const int count = port->backend->read(port, bytes, capacity);
    return count == 0 && hung_up(port) ? ALE_PORT_GONE : count;
}

int ale_port_write(ale_port_t *port, const uint8_t *bytes, size_t count, int32_t timeout_ms)
{
    const int64_t deadline_ms = monotonic_ms() + timeout_ms;
    size_t done = 0;
    while (done < count) {
        const int written = port->backend->write(port, bytes + done, count - done);
        if (written < 0) {
            return written;
        }
        done += (size_t)written;
        if (done == count) {
            break;
        }
        const int events = wait_until(port, POLLOUT, deadline_ms);
        if (events < 0 || (events & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
            return ALE_PORT_GONE;
        }
        if (events == 0) {
            return ALE_PORT_TIMEOUT;
        }
    }
    return ALE_PORT_OK;
}

bool ale_port_has_baud(const ale_port_t *port)
{
    return port->has_baud;
}

void ale_port_close(ale_port_t *port)
{
    if (port != NULL) {
        port->backend->close(port);
        if (port->lock >= 0) {
            close(port->lock);
        }
        free(port);
    }
}

/* The name of a process, or nothing where that is not to be seen. */
static void name_of(pid_t process, char name[NAME_BYTES])
{
    char path[NAME_BYTES * 2];
    snprintf(path, sizeof path, "/proc/%ld/comm", (long)process);
    FILE *file = fopen(path, "re");
    name[0] = '\0';
    if (file) {
        if (fgets(name, NAME_BYTES, file)) {
            name[strcspn(name, "\n")] = '\0';
        }
        fclose(file);
    }
}

static pid_t holder_of(const char *path)
{
    struct flock held = whole_of_it();
    const int there = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    const bool known = there >= 0 && fcntl(there, F_GETLK, &held) == 0 && held.l_type != F_UNLCK;
    if (there >= 0) {
        close(there);
    }
    return known && held.l_pid > 0 ? held.l_pid : 0;
}

void ale_port_explain(int status, const char *path, char words[ALE_PORT_WORDS])
{
    const pid_t process = status == ALE_PORT_BUSY ? holder_of(path) : 0;
    char name[NAME_BYTES] = "";
    if (process == 0) {
        snprintf(words, ALE_PORT_WORDS, "%s", ale_port_strerror(status));
        return;
    }
    name_of(process, name);
    snprintf(words, ALE_PORT_WORDS, "in use by another program: process %ld%s%s%s", (long)process,
             name[0] ? " (" : "", name, name[0] ? ")" : "");
}
