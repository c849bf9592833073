#include "command/message.h"

#include <stdbool.h>
#include <string.h>

#include <lcmtypes_ale_command_t.h>

enum { COUNT_BYTES = 4 };

typedef struct {
    const uint8_t *at;
    size_t left;
    bool broken;
} reader_t;

static uint64_t take_number(reader_t *reader, size_t size)
{
    if (reader->left < size) {
        reader->broken = true;
        reader->left = 0;
        return 0;
    }
    uint64_t value = 0;
    for (size_t k = 0; k < size; k++) {
        value = value << 8 | reader->at[k];
    }
    reader->at += size;
    reader->left -= size;
    return value;
}

static int64_t take_int64(reader_t *reader)
{
    return (int64_t)take_number(reader, sizeof(int64_t));
}

static bool is_printable(const uint8_t *text, size_t length)
{
    for (size_t k = 0; k < length; k++) {
        if (text[k] < ' ' || text[k] > '~') {
            return false;
        }
    }
    return true;
}

/* LCM's text: its length with the end, its characters, the end. */
static void take_text(reader_t *reader, char *out, size_t capacity)
{
    const uint64_t stated = take_number(reader, COUNT_BYTES);
    const size_t size = stated < capacity ? (size_t)stated : capacity;
    if (size < 1 || size != stated || size > reader->left || reader->at[size - 1] != '\0' ||
        !is_printable(reader->at, size - 1)) {
        reader->broken = true;
        return;
    }
    memcpy(out, reader->at, size);
    reader->at += size;
    reader->left -= size;
}

static void take_command(reader_t *reader, ale_command_t *command)
{
    reader->broken = take_int64(reader) != __lcmtypes_ale_command_t_get_hash();
    command->utime = take_int64(reader);
    command->expiry_utime = take_int64(reader);
    command->boot = take_int64(reader);
    command->counter = take_int64(reader);
    take_text(reader, command->robot, sizeof command->robot);
    take_text(reader, command->operator_name, sizeof command->operator_name);
    take_text(reader, command->verb, sizeof command->verb);
    const uint64_t args = take_number(reader, COUNT_BYTES);
    if (args > ALE_COMMAND_ARGS) {
        reader->broken = true;
        return;
    }
    command->args = (uint32_t)args;
    for (uint32_t k = 0; k < command->args; k++) {
        take_text(reader, command->arg[k], sizeof command->arg[k]);
    }
}

ale_message_kind_t ale_command_decode(const uint8_t *bytes, size_t count, ale_command_t *command,
                                      size_t *signed_bytes)
{
    reader_t reader = {.at = bytes, .left = count};
    take_command(&reader, command);
    *signed_bytes = (size_t)(reader.at - bytes);
    const uint64_t signature = take_number(&reader, COUNT_BYTES);
    if (reader.broken || signature != reader.left || (signature != 0 && signature != ALE_SIGNATURE_BYTES)) {
        return ALE_MESSAGE_MALFORMED;
    }
    return signature == 0 ? ALE_MESSAGE_UNSIGNED : ALE_MESSAGE_SIGNED;
}

static bool all_texts_end(const ale_command_t *command)
{
    bool end = memchr(command->robot, '\0', ALE_NAME_BYTES) &&
               memchr(command->operator_name, '\0', ALE_NAME_BYTES) &&
               memchr(command->verb, '\0', ALE_NAME_BYTES) && command->args <= ALE_COMMAND_ARGS;
    for (uint32_t k = 0; end && k < command->args; k++) {
        end = memchr(command->arg[k], '\0', ALE_COMMAND_ARG_BYTES) != NULL;
    }
    return end;
}

size_t ale_command_encode(const ale_command_t *command, const uint8_t signature[ALE_SIGNATURE_BYTES],
                          uint8_t bytes[ALE_COMMAND_BYTES])
{
    if (!all_texts_end(command)) {
        return 0;
    }
    char *args[ALE_COMMAND_ARGS];
    for (uint32_t k = 0; k < command->args; k++) {
        args[k] = (char *)command->arg[k];
    }
    const lcmtypes_ale_command_t message = {
        .utime = command->utime,
        .expiry_utime = command->expiry_utime,
        .boot = command->boot,
        .counter = command->counter,
        .robot = (char *)command->robot,
        .operator_name = (char *)command->operator_name,
        .verb = (char *)command->verb,
        .num_args = (int32_t)command->args,
        .args = args,
        .num_signature = signature ? ALE_SIGNATURE_BYTES : 0,
        .signature =
            (uint8_t *)(signature ? signature : bytes), /* of no bytes, but never NULL: LCM copies it */
    };
    const int length = lcmtypes_ale_command_t_encode(bytes, 0, ALE_COMMAND_BYTES, &message);
    return length > 0 ? (size_t)length : 0;
}
