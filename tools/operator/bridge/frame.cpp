#include "operator/bridge/frame.h"

#include <algorithm>
#include <cctype>

namespace bridge
{

namespace
{

bool is_channel(const std::string &name)
{
    return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isgraph(c); });
}

} // namespace

std::vector<uint8_t> encode(const Frame &frame)
{
    if (frame.channel.size() > most_channel || frame.size > most_message) {
        return {};
    }
    std::vector<uint8_t> bytes;
    bytes.reserve(1 + frame.channel.size() + frame.size);
    bytes.push_back(static_cast<uint8_t>(frame.channel.size()));
    bytes.insert(bytes.end(), frame.channel.begin(), frame.channel.end());
    bytes.insert(bytes.end(), frame.message, frame.message + frame.size);
    return bytes;
}

std::optional<Frame> decode(const uint8_t *bytes, size_t count)
{
    if (count < 1 || bytes[0] > most_channel || bytes[0] > count - 1 || (bytes[0] == 0 && count > 1)) {
        return std::nullopt;
    }
    Frame frame;
    frame.channel.assign(reinterpret_cast<const char *>(bytes) + 1, bytes[0]);
    frame.message = bytes + 1 + bytes[0];
    frame.size = count - 1 - bytes[0];
    return is_channel(frame.channel) ? std::optional<Frame>(frame) : std::nullopt;
}

} // namespace bridge
