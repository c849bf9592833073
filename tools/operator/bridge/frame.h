/* What one datagram of the link carries: a hello, or one LCM message with its channel. Pure functions.
 *
 *   "ALEB" | version 1 | kind | session (4) | sequence (4) | channel length (1) | channel | message
 *
 * Numbers are big-endian. The session is drawn at random at the start of an end; the sequence counts its
 * messages from
 * 1. Larger datagrams than one frame on the air travel in fragments of IP. */
#ifndef BRIDGE_FRAME_H
#define BRIDGE_FRAME_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bridge
{

enum class Kind : uint8_t { hello = 0, message = 1 };

struct Frame {
    Kind kind = Kind::hello;
    uint32_t session = 0;
    uint32_t sequence = 0; /* of the last message, when it is a hello */
    std::string channel;
    const uint8_t *message = nullptr; /* within the datagram */
    size_t size = 0;
};

/* The longest message that a datagram holds beside the longest channel (63 characters, LCM's limit). */
constexpr size_t most_channel = 63;
constexpr size_t most_message = 65000;

/* Empty when channel or message are too long. */
std::vector<uint8_t> encode(const Frame &frame);

/* Nothing when the bytes are no datagram of this link. */
std::optional<Frame> decode(const uint8_t *bytes, size_t count);

} // namespace bridge

#endif
