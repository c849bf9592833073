/* LCM's messages as bytes on named channels: what every program here joins the bus by.
 *
 *   char error[ALE_LCM_URL_ERROR];
 *   ale_wire_t *wire = ale_wire_open(url, error);
 *   ale_wire_subscribe(wire, "ALE_POSE", take, user);
 *   while (ale_wire_receive(wire, 100, 64) >= 0) ...        (calls `take`)
 *   ale_wire_close(wire);
 *
 * udpm:// is spoken by udpm.h, which bounds what a message may cost; tcpq://, memq:// and file:// by liblcm
 * (liblcm.h). One owner thread. What comes in is bytes that nobody has looked at but for their length. */
#ifndef ALE_LCM_WIRE_H
#define ALE_LCM_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lcm/incoming.h"
#include "lcm/url.h"

typedef struct ale_wire ale_wire_t;

/* url NULL or empty: the environment's LCM_DEFAULT_URL, else LCM's default. The wire is the caller's to
 * close. NULL and one line for people in error: what ale_lcm_url and ale_lcm_route say, no socket, no memory.
 */
ale_wire_t *ale_wire_open(const char *url, char error[ALE_LCM_URL_ERROR]);

/* The same, where there is no route for multicast, too: the bus is joined when there is one. */
ale_wire_t *ale_wire_open_early(const char *url, char error[ALE_LCM_URL_ERROR]);

/* Joins the bus again where the network has changed: a route has come, an interface has gone and come back.
 * Looks once a second at most; ale_wire_receive does so by itself. Whether there is a route. */
bool ale_wire_tend(ale_wire_t *wire);

/* What the names of all channels begin with on the bus, and nowhere else: in place of what the URL says of
 * it. Before the first subscription. 0, or -1: no prefix (ale_lcm_is_prefix). */
int ale_wire_set_prefix(ale_wire_t *wire, const char *prefix);

/* NULL: nothing. */
void ale_wire_close(ale_wire_t *wire);

/* Never waits for a reader. 0, or -1: too long (64 KiB), no name for a channel, or the system refuses. */
int ale_wire_send(ale_wire_t *wire, const char *channel, const uint8_t *bytes, size_t count);

/* `take` is called for what comes on this channel (1 to 63 characters, the prefix among them, taken
 * literally); at most 64 subscriptions. 0, or -1: too many, no such name, or the bus cannot be listened to
 * (errno). */
int ale_wire_subscribe(ale_wire_t *wire, const char *channel, ale_lcm_take_t take, void *user);

/* For poll: readable while messages wait. -1 before the first subscription. */
int ale_wire_descriptor(ale_wire_t *wire);

/* Waits up to timeout_ms for messages of the channels subscribed to (0: looks only), then handles what has
 * come, looking at `most` datagrams at a time. The number handled; 0 also when a signal came; -1 when the bus
 * can no longer be received. */
int ale_wire_receive(ale_wire_t *wire, int timeout_ms, int most);

/* Who sent the message that is just being handed on: a number for each socket that sends, or 0 where the
 * transport does not say (all but udpm://). Anybody may claim to be anybody. */
uint64_t ale_wire_sender(const ale_wire_t *wire);

/* Whether what is sent comes back, as it does unless a firewall or a missing route forbids it: sends on LCM's
 * channel for that, LCM_SELF_TEST, and waits up to timeout_ms. Other messages that come are handled
 * meanwhile. After the first subscription only. */
bool ale_wire_hears_itself(ale_wire_t *wire, int timeout_ms);

ale_lcm_dropped_t ale_wire_dropped(const ale_wire_t *wire);

#endif
