#include "lcm/url.h"

#include <arpa/inet.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define UDPM "udpm://"
#define DEFAULT_GROUP "239.255.76.67"
#define DEFAULT_PORT "7667"

enum { GROUP_BYTES = 64, MOST_PORT = 65535 };

/* A copy of the first characters before any of `ends`; `otherwise` where there are none. */
static void take_part(const char *from, const char *ends, const char *otherwise, char part[GROUP_BYTES])
{
    const int length = (int)strcspn(from, ends);
    snprintf(part, GROUP_BYTES, "%.*s", length > 0 ? length : GROUP_BYTES, length > 0 ? from : otherwise);
}

static bool is_port(const char *text)
{
    char *end = NULL;
    const long port = strtol(text, &end, 10);
    return *end == '\0' && port > 0 && port <= MOST_PORT;
}

static bool is_reachable(const struct sockaddr_in *to)
{
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const bool reachable = probe >= 0 && connect(probe, (const struct sockaddr *)to, sizeof *to) == 0;
    if (probe >= 0) {
        close(probe);
    }
    return reachable;
}

/* udpm://GROUP:PORT?OPTIONS, each of which may be missing. */
static int check_group(const char *url, char error[ALE_LCM_URL_ERROR])
{
    char group[GROUP_BYTES];
    char port[GROUP_BYTES];
    const char *rest = url + strlen(UDPM);
    take_part(rest, ":?/", DEFAULT_GROUP, group);
    rest += strcspn(rest, ":?/");
    take_part(*rest == ':' ? rest + 1 : "", "?/", DEFAULT_PORT, port);
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(7667)};
    if (inet_pton(AF_INET, group, &to.sin_addr) != 1) {
        snprintf(error, ALE_LCM_URL_ERROR, "LCM: %s is not an address", group);
    } else if (!IN_MULTICAST(ntohl(to.sin_addr.s_addr))) {
        snprintf(error, ALE_LCM_URL_ERROR,
                 "LCM: %s is not a multicast address (224.0.0.0 to 239.255.255.255)", group);
    } else if (!is_port(port)) {
        snprintf(error, ALE_LCM_URL_ERROR, "LCM: %s is not a port", port);
    } else if (!is_reachable(&to)) {
        snprintf(error, ALE_LCM_URL_ERROR,
                 "LCM: no route for multicast to %s; without a network, as root: "
                 "ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo",
                 group);
    } else {
        return 0;
    }
    return -1;
}

static int check(const char *url, char error[ALE_LCM_URL_ERROR])
{
    static const char *const kinds[] = {UDPM, "mpudpm://", "tcpq://", "memq://", "file://"};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        if (strncmp(url, kinds[k], strlen(kinds[k])) == 0) {
            return k == 0 ? check_group(url, error) : 0;
        }
    }
    snprintf(error, ALE_LCM_URL_ERROR, "LCM: %.100s is no URL that LCM knows (udpm://..., tcpq://...)", url);
    return -1;
}

const char *ale_lcm_url(const char *url, char error[ALE_LCM_URL_ERROR])
{
    const char *chosen = url && *url ? url : getenv("LCM_DEFAULT_URL");
    if (!chosen || !*chosen) {
        chosen = UDPM;
    }
    return check(chosen, error) < 0 ? NULL : chosen;
}
