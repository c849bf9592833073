/* A message of a recording, which anybody may have written. */
#ifndef CONSOLE_RECORDED_MESSAGE_H
#define CONSOLE_RECORDED_MESSAGE_H

#include <cstdint>
#include <exception>
#include <optional>
#include <vector>

#include "common/feed/checks.h"

namespace console
{

/* Nothing: the bytes are of another type, or make no sense. */
template <class Message> std::optional<Message> recorded_message(const std::vector<uint8_t> &bytes)
{
    try {
        Message message;
        if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) >= 0) {
            feed::check(message);
            return message;
        }
    } catch (const std::exception &) {
        /* out of this world */
    }
    return std::nullopt;
}

} // namespace console

#endif
