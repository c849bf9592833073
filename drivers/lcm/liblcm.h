/* The kinds of URL that do not listen to a network, by liblcm: tcpq:// (a hub), memq:// (this program alone),
 * file:// (a log, played or written). Who names a hub trusts it: liblcm believes the lengths that it sends.
 *
 * liblcm starts a thread of its own for the first two at the first subscription; it inherits policy, affinity
 * and signal mask of the thread that subscribes. */
#ifndef ALE_LCM_LIBLCM_H
#define ALE_LCM_LIBLCM_H

#include "lcm/incoming.h"

typedef struct ale_liblcm ale_liblcm_t;

/* NULL: liblcm cannot open it, or no memory. */
ale_liblcm_t *ale_liblcm_open(const char *url);
void ale_liblcm_close(ale_liblcm_t *liblcm);

/* Subscribes to all channels; again: nothing. 0 or -1. */
int ale_liblcm_listen(ale_liblcm_t *liblcm, ale_lcm_take_t take, void *user);
int ale_liblcm_descriptor(ale_liblcm_t *liblcm);

/* 0 or -1. */
int ale_liblcm_send(ale_liblcm_t *liblcm, const char *channel, const uint8_t *bytes, size_t count);

/* Hands one message on. 1, 0 when none waits, -1 when liblcm's thread is broken. Never waits. */
int ale_liblcm_receive(ale_liblcm_t *liblcm);

#endif
