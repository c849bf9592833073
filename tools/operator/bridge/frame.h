/* What a datagram of the link carries once it is opened: an LCM message with its channel, or nothing but that
 * the other end is there. Pure functions.
 *
 *   channel length (1) | channel | message             (length 0: nothing) */
#ifndef BRIDGE_FRAME_H
#define BRIDGE_FRAME_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bridge
{

struct Frame {
    std::string channel;
    const uint8_t *message = nullptr; /* within the bytes */
    size_t size = 0;
};

/* The longest message that a datagram holds beside the longest channel (63 characters, LCM's limit). */
constexpr size_t most_channel = 63;
constexpr size_t most_message = 65000;

/* Empty when channel or message are too long. */
std::vector<uint8_t> encode(const Frame &frame);

/* Nothing when the bytes are no frame. */
std::optional<Frame> decode(const uint8_t *bytes, size_t count);

} // namespace bridge

#endif
