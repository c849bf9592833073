/* Whether bytes were said by a robot whose key is known. A message that is vouched for begins with 8 bytes of
 * its type, 8 of its utime and the first 8 of the robot's public key, and ends with the robot's signature
 * over all bytes before it (lib/messages/ale.lcm: vouched_t). Pure functions on bytes; nothing is allocated.
 */
#ifndef ALE_COMMAND_VOUCHED_H
#define ALE_COMMAND_VOUCHED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/keys.h"

enum { ALE_VOUCHED_HEAD = 24, ALE_DIGEST_BYTES = 32 };

/* What stands in the message for the key. */
int64_t ale_vouched_key(const ale_public_key_t *key);

/* Signs the message in place: its last ALE_SIGNATURE_BYTES are set. count: at least that and the head. About
 * 0.1 ms. */
void ale_vouched_sign(const ale_secret_key_t *secret, uint8_t *bytes, size_t count);

/* Any bytes. Whether one of the robots has signed them. Nothing of them is to be looked at before. At most
 * one signature is checked, about 0.2 ms. */
bool ale_is_vouched(const ale_keys_t *robots, const uint8_t *bytes, size_t count);

/* Whether the robot of that key, as it stands in a message, may call itself so: a name in the list belongs to
 * the key that it stands beside there. One that is not in the list is free. */
bool ale_may_be_called(const ale_keys_t *robots, int64_t key, const char *name);

/* The first 8 bytes of BLAKE2b (32 bytes) over the bytes, as vouched_t has it of a pose. */
int64_t ale_digest(const uint8_t *bytes, size_t count);

#endif
