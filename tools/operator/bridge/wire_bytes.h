/* How every datagram of the link begins, and numbers in it: "ALEB" | version 2 | kind. Big-endian. */
#ifndef BRIDGE_WIRE_BYTES_H
#define BRIDGE_WIRE_BYTES_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

namespace bridge
{

enum class Kind : uint8_t { hello = 1, answer = 2, data = 3 };

constexpr uint8_t link_magic[] = {'A', 'L', 'E', 'B', 2};
constexpr size_t link_head = sizeof link_magic + 1;

inline std::vector<uint8_t> begin_datagram(Kind kind)
{
    std::vector<uint8_t> bytes(link_magic, link_magic + sizeof link_magic);
    bytes.push_back(static_cast<uint8_t>(kind));
    return bytes;
}

inline std::optional<Kind> kind_of(const std::vector<uint8_t> &bytes)
{
    if (bytes.size() < link_head || std::memcmp(bytes.data(), link_magic, sizeof link_magic) != 0 ||
        bytes[sizeof link_magic] < 1 || bytes[sizeof link_magic] > 3) {
        return std::nullopt;
    }
    return static_cast<Kind>(bytes[sizeof link_magic]);
}

inline void put_number(std::vector<uint8_t> &bytes, uint64_t value)
{
    for (int shift = 56; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<uint8_t>(value >> shift));
    }
}

inline uint64_t number_at(const uint8_t *bytes)
{
    uint64_t value = 0;
    for (int k = 0; k < 8; k++) {
        value = value << 8 | bytes[k];
    }
    return value;
}

} // namespace bridge

#endif
