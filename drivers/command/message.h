/* Bytes of an ALE_COMMAND, from and to ale_command_t. Pure functions, any thread; nothing is allocated.
 *
 *   | what is signed                                                        | 64 | signature |
 *   | type, utime, expiry, boot, counter, robot, operator, verb, arguments  |    |           |
 *
 * The reader takes one form only (texts printable, ended once, nothing left over), so the bytes that were
 * signed are those that are obeyed. LCM's generated decoder is not used for it: it allocates what a
 * hostile count asks for. */
#ifndef ALE_COMMAND_MESSAGE_H
#define ALE_COMMAND_MESSAGE_H

#include <stddef.h>
#include <stdint.h>

#include "command/command.h"

typedef enum { ALE_MESSAGE_SIGNED, ALE_MESSAGE_UNSIGNED, ALE_MESSAGE_MALFORMED } ale_message_kind_t;

/* Any bytes. Malformed: *command is undefined. Signed: the signature is over the first *signed_bytes and lies
 * 4 bytes behind them. At most `count` steps. */
ale_message_kind_t ale_command_decode(const uint8_t *bytes, size_t count, ale_command_t *command,
                                      size_t *signed_bytes);

/* The message with a signature, or without (NULL). Its length, or 0 when a text of the command does not end
 * within its field. */
size_t ale_command_encode(const ale_command_t *command, const uint8_t signature[ALE_SIGNATURE_BYTES],
                          uint8_t bytes[ALE_COMMAND_BYTES]);

#endif
