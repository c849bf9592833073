/* LCM's UDP multicast (udpm://) by sockets of our own. liblcm is not given what comes from a network:
 * upstream_faults.md says why. No thread; memory is taken when the bus is joined, none a message.
 *
 * With ttl 0 the kernel hands over only what was sent on this machine (a filter on the socket: looped back by
 * the kernel, or come over the loopback interface). What other machines send is dropped before it takes room
 * in the queue, whatever address it claims to come from. With a higher ttl everybody on the network is heard.
 * Either way only datagrams to the group are: the socket is bound to its address. */
#ifndef ALE_LCM_UDPM_H
#define ALE_LCM_UDPM_H

#include <stddef.h>
#include <stdint.h>

#include "lcm/incoming.h"
#include "lcm/url.h"

typedef struct ale_udpm ale_udpm_t;

/* For sending, at first. NULL: no socket or no memory (errno). */
ale_udpm_t *ale_udpm_open(const ale_lcm_group_t *group);
void ale_udpm_close(ale_udpm_t *udpm);

/* Joins the group, if there is a route to it; again: nothing. From now on messages wait in the kernel, in
 * 2 MiB where it grants them. 0, or -1: no socket, no memory, or another program holds the port alone
 * (errno). */
int ale_udpm_listen(ale_udpm_t *udpm);

/* Looks where the route to the group leads at this moment, and joins the group there if that is not done yet:
 * networks come late, and interfaces come and go. The descriptor stays the same. 0, or -1: there is no route.
 * Waits no longer than the kernel takes to set up an interface. */
int ale_udpm_join(ale_udpm_t *udpm);

/* For poll. -1: does not listen. */
int ale_udpm_descriptor(const ale_udpm_t *udpm);

/* One datagram: message of at most 65,507 bytes less 9 and the channel. 0, or -1: too long, no such channel,
 * or the system does not take it at once (it never waits). */
int ale_udpm_send(ale_udpm_t *udpm, const char *channel, const uint8_t *bytes, size_t count);

/* Takes one datagram and hands on the message that it completes, if any: valid in `take` only. 1 when there
 * was a datagram, 0 when none waits, -1 when the socket is broken (errno). Never waits. */
int ale_udpm_receive(ale_udpm_t *udpm, ale_lcm_take_t take, void *user);

/* Who sent the message that is just being handed on: a number for each socket that sends. */
uint64_t ale_udpm_sender(const ale_udpm_t *udpm);

/* What came and was not handed on. */
ale_lcm_dropped_t ale_udpm_dropped(const ale_udpm_t *udpm);

#endif
