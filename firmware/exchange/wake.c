#include "exchange/wake.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#define NS_PER_S 1000000000

int ale_wake_open(void)
{
    return eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
}

void ale_wake_close(int wake)
{
    if (wake >= 0) {
        close(wake);
    }
}

void ale_wake_post(int wake)
{
    eventfd_write(wake, 1);
}

void ale_wake_wait(int wake, int64_t wait_ns)
{
    ale_wake_wait_or_read(wake, -1, wait_ns);
}

bool ale_wake_wait_or_read(int wake, int source, int64_t wait_ns)
{
    struct pollfd sources[] = {{.fd = wake, .events = POLLIN}, {.fd = source, .events = POLLIN}};
    const struct timespec wait = {.tv_sec = (time_t)(wait_ns / NS_PER_S),
                                  .tv_nsec = (long)(wait_ns % NS_PER_S)};
    eventfd_t posts = 0;
    ppoll(sources, 2, &wait, NULL);
    eventfd_read(wake, &posts);
    return sources[1].revents != 0;
}
