#include "lcm/wire.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "lcm/datagram.h"
#include "lcm/liblcm.h"
#include "lcm/udpm.h"

#define SELF_TEST "LCM_SELF_TEST"

enum { MAX_SUBSCRIPTIONS = 64, SELF_TEST_DATAGRAMS = 64, TEND_MS = 1000 };

typedef struct {
    char channel[ALE_DATAGRAM_CHANNEL + 1];
    ale_lcm_take_t take;
    void *user;
} subscription_t;

/* One of udpm and liblcm is there. */
struct ale_wire {
    ale_udpm_t *udpm;
    ale_liblcm_t *liblcm;
    char prefix[ALE_LCM_PREFIX + 1];
    int subscriptions;
    subscription_t subscription[MAX_SUBSCRIPTIONS];
    int handled;
    bool heard_itself;
    int64_t next_tend_ms;
    bool has_route; /* when it was looked at last */
};

ale_wire_t *ale_wire_open_early(const char *url, char error[ALE_LCM_URL_ERROR])
{
    const char *chosen = ale_lcm_url(url, error);
    ale_lcm_group_t group;
    if (!chosen || (ale_lcm_is_group(chosen) && ale_lcm_group(chosen, &group, error) < 0)) {
        return NULL;
    }
    ale_wire_t *wire = calloc(1, sizeof *wire);
    if (wire && ale_lcm_is_group(chosen)) {
        wire->udpm = ale_udpm_open(&group);
        memcpy(wire->prefix, group.prefix, sizeof wire->prefix);
    } else if (wire) {
        wire->liblcm = ale_liblcm_open(chosen);
    }
    if (!wire || !(wire->udpm || wire->liblcm)) {
        snprintf(error, ALE_LCM_URL_ERROR, "LCM: %.100s cannot be opened", chosen);
        free(wire);
        return NULL;
    }
    return wire;
}

ale_wire_t *ale_wire_open(const char *url, char error[ALE_LCM_URL_ERROR])
{
    const char *chosen = ale_lcm_url(url, error);
    ale_lcm_group_t group;
    if (!chosen || (ale_lcm_is_group(chosen) &&
                    (ale_lcm_group(chosen, &group, error) < 0 || ale_lcm_route(&group, error) < 0))) {
        return NULL;
    }
    return ale_wire_open_early(chosen, error);
}

void ale_wire_close(ale_wire_t *wire)
{
    if (wire) {
        ale_udpm_close(wire->udpm);
        ale_liblcm_close(wire->liblcm);
        free(wire);
    }
}

int ale_wire_set_prefix(ale_wire_t *wire, const char *prefix)
{
    if (!ale_lcm_is_prefix(prefix)) {
        return -1;
    }
    snprintf(wire->prefix, sizeof wire->prefix, "%s", prefix);
    return 0;
}

/* As it is called on the bus. 0, or -1: longer than a channel may be, or nothing. */
static int full_name(const ale_wire_t *wire, const char *channel, char name[ALE_DATAGRAM_CHANNEL + 1])
{
    const int length = snprintf(name, ALE_DATAGRAM_CHANNEL + 1, "%s%s", wire->prefix, channel);
    return channel[0] == '\0' || length > ALE_DATAGRAM_CHANNEL ? -1 : 0;
}

static int send_as(ale_wire_t *wire, const char *channel, const uint8_t *bytes, size_t count)
{
    return wire->udpm ? ale_udpm_send(wire->udpm, channel, bytes, count)
                      : ale_liblcm_send(wire->liblcm, channel, bytes, count);
}

int ale_wire_send(ale_wire_t *wire, const char *channel, const uint8_t *bytes, size_t count)
{
    char name[ALE_DATAGRAM_CHANNEL + 1];
    return full_name(wire, channel, name) < 0 ? -1 : send_as(wire, name, bytes, count);
}

static void deliver(void *user, const char *channel, const uint8_t *bytes, size_t count)
{
    ale_wire_t *wire = user;
    wire->heard_itself = wire->heard_itself || strcmp(channel, SELF_TEST) == 0;
    for (int k = 0; k < wire->subscriptions; k++) {
        const subscription_t *subscription = &wire->subscription[k];
        if (strcmp(channel, subscription->channel) == 0) {
            wire->handled++;
            subscription->take(subscription->user, channel + strlen(wire->prefix), bytes, count);
        }
    }
}

static int listen_to_it(ale_wire_t *wire)
{
    return wire->udpm ? ale_udpm_listen(wire->udpm) : ale_liblcm_listen(wire->liblcm, deliver, wire);
}

int ale_wire_subscribe(ale_wire_t *wire, const char *channel, ale_lcm_take_t take, void *user)
{
    char name[ALE_DATAGRAM_CHANNEL + 1];
    if (full_name(wire, channel, name) < 0 || wire->subscriptions == MAX_SUBSCRIPTIONS) {
        errno = EINVAL;
        return -1;
    }
    subscription_t *subscription = &wire->subscription[wire->subscriptions];
    *subscription = (subscription_t){.take = take, .user = user};
    memcpy(subscription->channel, name, sizeof name);
    if (listen_to_it(wire) < 0) {
        return -1;
    }
    wire->subscriptions++;
    return 0;
}

int ale_wire_descriptor(ale_wire_t *wire)
{
    return wire->udpm ? ale_udpm_descriptor(wire->udpm) : ale_liblcm_descriptor(wire->liblcm);
}

static int receive_one(ale_wire_t *wire)
{
    return wire->udpm ? ale_udpm_receive(wire->udpm, deliver, wire) : ale_liblcm_receive(wire->liblcm);
}

static int64_t now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

bool ale_wire_tend(ale_wire_t *wire)
{
    if (!wire->udpm) {
        return true;
    }
    const int64_t now = now_ms();
    if (now >= wire->next_tend_ms) {
        wire->next_tend_ms = now + TEND_MS;
        wire->has_route = ale_udpm_join(wire->udpm) == 0;
    }
    return wire->has_route;
}

/* What waits, but `most` datagrams only: whoever floods the bus does not keep its reader from other work. */
static int take_what_waits(ale_wire_t *wire, int most)
{
    int taken = 1;
    for (int k = 0; k < most && taken > 0; k++) {
        taken = receive_one(wire);
    }
    return taken < 0 ? -1 : 0;
}

int ale_wire_receive(ale_wire_t *wire, int timeout_ms, int most)
{
    const int64_t end_ms = now_ms() + timeout_ms;
    int64_t left_ms = timeout_ms;
    wire->handled = 0;
    ale_wire_tend(wire);
    do {
        struct pollfd ready = {.fd = ale_wire_descriptor(wire), .events = POLLIN};
        const int found = poll(&ready, 1, (int)left_ms);
        if (found < 0) {
            return errno == EINTR ? 0 : -1;
        }
        if (found > 0 && take_what_waits(wire, most) < 0) {
            return -1;
        }
        left_ms = end_ms - now_ms();
    } while (wire->handled == 0 && left_ms > 0);
    return wire->handled;
}

bool ale_wire_hears_itself(ale_wire_t *wire, int timeout_ms)
{
    static const uint8_t words[] = "lcm self test";
    const int64_t end_ms = now_ms() + timeout_ms;
    wire->heard_itself = false;
    send_as(wire, SELF_TEST, words, sizeof words - 1);
    for (int64_t left_ms = timeout_ms; !wire->heard_itself && left_ms > 0; left_ms = end_ms - now_ms()) {
        struct pollfd ready = {.fd = ale_wire_descriptor(wire), .events = POLLIN};
        if (poll(&ready, 1, (int)left_ms) > 0 && take_what_waits(wire, SELF_TEST_DATAGRAMS) < 0) {
            break;
        }
    }
    return wire->heard_itself;
}

uint64_t ale_wire_sender(const ale_wire_t *wire)
{
    return wire->udpm ? ale_udpm_sender(wire->udpm) : 0;
}

ale_lcm_dropped_t ale_wire_dropped(const ale_wire_t *wire)
{
    return wire->udpm ? ale_udpm_dropped(wire->udpm) : (ale_lcm_dropped_t){0};
}
