#include "lcm/url.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define UDPM "udpm://"
#define DEFAULT_GROUP "239.255.76.67"
#define DEFAULT_PORT "7667"

enum { PART_BYTES = 64, MOST_PORT = 65535, MOST_TTL = 255, MOST_RECEIVE_BYTES = 1 << 30 };

/* A copy of the first characters before any of `ends`; `otherwise` where there are none. */
static void take_part(const char *from, const char *ends, const char *otherwise, char part[PART_BYTES])
{
    const int length = (int)strcspn(from, ends);
    snprintf(part, PART_BYTES, "%.*s", length > 0 ? length : PART_BYTES, length > 0 ? from : otherwise);
}

/* A whole number from least to most; -1: it is none. */
static long number_of(const char *text, long least, long most)
{
    char *end = NULL;
    const long number = strtol(text, &end, 10);
    return end != text && *end == '\0' && number >= least && number <= most ? number : -1;
}

static int take_address(const char *rest, ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR])
{
    char address[PART_BYTES];
    char port[PART_BYTES];
    take_part(rest, ":?/", DEFAULT_GROUP, address);
    rest += strcspn(rest, ":?/");
    take_part(*rest == ':' ? rest + 1 : "", "?/", DEFAULT_PORT, port);
    const long number = number_of(port, 1, MOST_PORT);
    struct in_addr parsed = {0};
    const bool is_address = inet_pton(AF_INET, address, &parsed) == 1;
    group->address = ntohl(parsed.s_addr);
    group->port = (uint16_t)number;
    if (!is_address) {
        snprintf(error, ALE_LCM_URL_ERROR, "LCM: %s is not an address", address);
    } else if (!IN_MULTICAST(group->address)) {
        snprintf(error, ALE_LCM_URL_ERROR,
                 "LCM: %s is not a multicast address (224.0.0.0 to 239.255.255.255)", address);
    } else if (number < 0) {
        snprintf(error, ALE_LCM_URL_ERROR, "LCM: %s is not a port", port);
    } else {
        return 0;
    }
    return -1;
}

bool ale_lcm_is_prefix(const char *text)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-/";
    const size_t length = strspn(text, letters);
    return length <= ALE_LCM_PREFIX && text[length] == '\0';
}

static int take_prefix(const char *text, ale_lcm_group_t *group)
{
    if (!ale_lcm_is_prefix(text)) {
        return -1;
    }
    snprintf(group->prefix, sizeof group->prefix, "%.*s", ALE_LCM_PREFIX, text);
    return 0;
}

/* What stands behind "name=" of an option; NULL: it is another one. */
static const char *value_of(const char *option, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(option, name, length) == 0 && option[length] == '=' ? option + length + 1 : NULL;
}

static int take_ttl(const char *text, ale_lcm_group_t *group)
{
    const long ttl = number_of(text, 0, MOST_TTL);
    group->ttl = (uint8_t)ttl;
    return ttl < 0 ? -1 : 0;
}

static int take_receive_bytes(const char *text, ale_lcm_group_t *group)
{
    const long bytes = number_of(text, 1, MOST_RECEIVE_BYTES);
    group->receive_bytes = (int32_t)bytes;
    return bytes < 0 ? -1 : 0;
}

/* One option, as in "ttl=0". LCM's own transmit_only has lost its meaning, there too. */
static int take_option(const char *option, ale_lcm_group_t *group)
{
    static const struct {
        const char *name;
        int (*take)(const char *text, ale_lcm_group_t *group);
    } options[] = {{"ttl", take_ttl}, {"recv_buf_size", take_receive_bytes}, {"prefix", take_prefix}};
    for (size_t k = 0; k < sizeof options / sizeof options[0]; k++) {
        const char *value = value_of(option, options[k].name);
        if (value) {
            return options[k].take(value, group);
        }
    }
    return strcmp(option, "transmit_only") == 0 || value_of(option, "transmit_only") ? 0 : -1;
}

static int take_options(const char *options, ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR])
{
    while (*options) {
        char option[PART_BYTES];
        take_part(options, "&", "", option);
        if (*option && take_option(option, group) < 0) {
            snprintf(error, ALE_LCM_URL_ERROR,
                     "LCM: \"%s\": udpm takes ttl=0 to 255, recv_buf_size=BYTES and prefix=TEXT "
                     "(%d letters, digits and . _ - / at most)",
                     option, ALE_LCM_PREFIX);
            return -1;
        }
        options += strcspn(options, "&");
        options += *options == '&';
    }
    return 0;
}

bool ale_lcm_is_group(const char *url)
{
    return strncmp(url, UDPM, strlen(UDPM)) == 0;
}

int ale_lcm_group(const char *url, ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR])
{
    *group = (ale_lcm_group_t){0};
    const char *options = strchr(url, '?');
    return take_address(url + strlen(UDPM), group, error) < 0
               ? -1
               : take_options(options ? options + 1 : "", group, error);
}

static int check(const char *url, char error[ALE_LCM_URL_ERROR])
{
    static const char *const others[] = {"tcpq://", "memq://", "file://"};
    if (ale_lcm_is_group(url)) {
        ale_lcm_group_t group;
        return ale_lcm_group(url, &group, error);
    }
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
        if (strncmp(url, others[k], strlen(others[k])) == 0) {
            return 0;
        }
    }
    snprintf(error, ALE_LCM_URL_ERROR, "LCM: %.100s is no URL that is known here (udpm://..., tcpq://...)",
             url);
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

static bool is_reachable(const ale_lcm_group_t *group)
{
    const struct sockaddr_in to = {
        .sin_family = AF_INET, .sin_port = htons(group->port), .sin_addr.s_addr = htonl(group->address)};
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const bool reachable = probe >= 0 && connect(probe, (const struct sockaddr *)&to, sizeof to) == 0;
    if (probe >= 0) {
        close(probe);
    }
    return reachable;
}

int ale_lcm_route(const ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR])
{
    if (is_reachable(group)) {
        return 0;
    }
    char address[INET_ADDRSTRLEN];
    const struct in_addr unreachable = {htonl(group->address)};
    inet_ntop(AF_INET, &unreachable, address, sizeof address);
    snprintf(error, ALE_LCM_URL_ERROR,
             "LCM: no route for multicast to %s; without a network, as root: "
             "ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo",
             address);
    return -1;
}
