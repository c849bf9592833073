#include "wake.h"

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
    struct pollfd source = {.fd = wake, .events = POLLIN};
    const struct timespec wait = {.tv_sec = (time_t)(wait_ns / NS_PER_S),
                                  .tv_nsec = (long)(wait_ns % NS_PER_S)};
    eventfd_t posts = 0;
    ppoll(&source, 1, &wait, NULL);
    eventfd_read(wake, &posts);
}
