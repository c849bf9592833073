#include "operator/bridge/frame.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace bridge
{

namespace
{

constexpr uint8_t magic[] = {'A', 'L', 'E', 'B'};
constexpr uint8_t version = 1;
constexpr size_t header = sizeof magic + 2 + 4 + 4 + 1;

void put_number(std::vector<uint8_t> &bytes, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<uint8_t>(value >> shift));
    }
}

uint32_t number_at(const uint8_t *bytes)
{
    return static_cast<uint32_t>(bytes[0]) << 24 | static_cast<uint32_t>(bytes[1]) << 16 |
           static_cast<uint32_t>(bytes[2]) << 8 | bytes[3];
}

bool is_channel(const std::string &name)
{
    return !name.empty() &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isgraph(c); });
}

} // namespace

std::vector<uint8_t> encode(const Frame &frame)
{
    if (frame.channel.size() > most_channel || frame.size > most_message) {
        return {};
    }
    std::vector<uint8_t> bytes(std::begin(magic), std::end(magic));
    bytes.reserve(header + frame.channel.size() + frame.size);
    bytes.push_back(version);
    bytes.push_back(static_cast<uint8_t>(frame.kind));
    put_number(bytes, frame.session);
    put_number(bytes, frame.sequence);
    bytes.push_back(static_cast<uint8_t>(frame.channel.size()));
    bytes.insert(bytes.end(), frame.channel.begin(), frame.channel.end());
    bytes.insert(bytes.end(), frame.message, frame.message + frame.size);
    return bytes;
}

std::optional<Frame> decode(const uint8_t *bytes, size_t count)
{
    if (count < header || std::memcmp(bytes, magic, sizeof magic) != 0 || bytes[4] != version ||
        bytes[5] > 1) {
        return std::nullopt;
    }
    const size_t name = bytes[header - 1];
    Frame frame;
    frame.kind = static_cast<Kind>(bytes[5]);
    frame.session = number_at(bytes + 6);
    frame.sequence = number_at(bytes + 10);
    if (frame.kind == Kind::hello) {
        return name == 0 && count == header ? std::optional<Frame>(frame) : std::nullopt;
    }
    if (name > most_channel || name > count - header) {
        return std::nullopt;
    }
    frame.channel.assign(reinterpret_cast<const char *>(bytes) + header, name);
    frame.message = bytes + header + name;
    frame.size = count - header - name;
    return is_channel(frame.channel) ? std::optional<Frame>(frame) : std::nullopt;
}

} // namespace bridge
