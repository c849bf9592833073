#include "system/service.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FEEDS_PER_PERIOD = 4, NS_PER_US = 1000 };

/* A name that begins with @ is in the kernel's abstract space, where it begins with a zero byte. */
static int set_address(ale_service_t *service, const char *name)
{
    const size_t length = strlen(name);
    struct sockaddr_un *address = &service->address;
    if ((name[0] != '/' && name[0] != '@') || length >= sizeof address->sun_path) {
        return -1;
    }
    memset(address, 0, sizeof *address);
    address->sun_family = AF_UNIX;
    memcpy(address->sun_path, name, length);
    if (name[0] == '@') {
        address->sun_path[0] = '\0';
    }
    service->address_bytes = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    return 0;
}

void ale_service_open(ale_service_t *service)
{
    const char *name = getenv("NOTIFY_SOCKET");
    const char *watchdog = getenv("WATCHDOG_USEC");
    memset(service, 0, sizeof *service);
    service->socket = -1;
    if (name && set_address(service, name) == 0) {
        service->socket = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    }
    if (watchdog) {
        service->feed_period_ns = strtoimax(watchdog, NULL, 10) * NS_PER_US / FEEDS_PER_PERIOD;
    }
}

void ale_service_close(ale_service_t *service)
{
    if (service->socket >= 0) {
        close(service->socket);
        service->socket = -1;
    }
}

void ale_service_tell(const ale_service_t *service, const char *text)
{
    if (service->socket >= 0) {
        sendto(service->socket, text, strlen(text), MSG_NOSIGNAL, (const struct sockaddr *)&service->address,
               service->address_bytes);
    }
}

void ale_service_feed(ale_service_t *service, uint32_t progress, int64_t now_ns)
{
    if (service->feed_period_ns > 0 && now_ns >= service->next_feed_ns && progress != service->progress) {
        service->progress = progress;
        service->next_feed_ns = now_ns + service->feed_period_ns;
        ale_service_tell(service, "WATCHDOG=1");
    }
}
