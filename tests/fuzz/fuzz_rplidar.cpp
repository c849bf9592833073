/* An RPLIDAR's bytes. The first byte of an input chooses how the rest is cut into pieces, which kind of
 * measurements comes, and whether each capsule gets its right sum, so that the fuzzer comes past the sums. */
#include "fuzz/rotary_bytes.hpp"

extern "C" {
#include "scanner/rplidar/rplidar_parse.h"
}

namespace
{

std::string with_sums(std::string bytes)
{
    for (size_t at = 0; at + ALE_RPLIDAR_CAPSULE <= bytes.size(); at += ALE_RPLIDAR_CAPSULE) {
        unsigned sum = 0;
        for (size_t k = 2; k < ALE_RPLIDAR_CAPSULE; k++) {
            sum ^= static_cast<uint8_t>(bytes[at + k]);
        }
        bytes[at] = static_cast<char>(0xa0U | (sum & 0xfU));
        bytes[at + 1] = static_cast<char>(0x50U | sum >> 4U);
    }
    return bytes;
}

std::string descriptor_of(unsigned type)
{
    return std::string("\xa5\x5a\x54\x00\x00\x40", 6) + static_cast<char>(type);
}

uint64_t seen_of(const std::string &bytes, size_t piece)
{
    ale_rplidar_parser_t parser{};
    fuzz::RotaryReader reader;
    reader.read(bytes, piece, [&](const uint8_t *at, uint32_t count, ale_rotary_packet_t *packet) {
        return ale_rplidar_parse(&parser, at, count, packet);
    });
    return reader.seen();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1) {
        return 0;
    }
    std::string bytes(data + 1, data + size);
    const unsigned types[] = {ALE_RPLIDAR_STANDARD, ALE_RPLIDAR_EXPRESS, ALE_RPLIDAR_DENSE};
    const unsigned kind = data[0] & 7U;
    if (kind < 6) {
        bytes = descriptor_of(types[kind % 3]) + (kind < 3 ? bytes : with_sums(bytes));
    }
    fuzz::require(seen_of(bytes, 1 + data[0] / 8U) == seen_of(bytes, bytes.size() + 1));
    return 0;
}
