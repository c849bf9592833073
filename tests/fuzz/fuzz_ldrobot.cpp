/* An LDROBOT's bytes. The first byte of an input chooses how the rest is cut into pieces and whether each
 * packet gets its right sum, so that the fuzzer comes past the sums. */
#include "fuzz/rotary_bytes.hpp"

extern "C" {
#include "scanner/ldrobot/ldrobot.h"
}

namespace
{

std::string with_sums(std::string bytes)
{
    for (size_t at = 0; at + ALE_LDROBOT_PACKET <= bytes.size(); at += ALE_LDROBOT_PACKET) {
        bytes[at] = '\x54';
        bytes[at + 1] = '\x2c';
        bytes[at + ALE_LDROBOT_PACKET - 1] = static_cast<char>(
            ale_ldrobot_sum(reinterpret_cast<const uint8_t *>(bytes.data()) + at, ALE_LDROBOT_PACKET - 1));
    }
    return bytes;
}

uint64_t seen_of(const std::string &bytes, size_t piece)
{
    ale_ldrobot_t state{};
    fuzz::RotaryReader reader;
    reader.read(bytes, piece, [&](const uint8_t *at, uint32_t count, ale_rotary_packet_t *packet) {
        return ale_ldrobot_parse(&state, at, count, packet);
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
    if ((data[0] & 1U) != 0) {
        bytes = with_sums(bytes);
    }
    fuzz::require(seen_of(bytes, 1 + data[0] / 2U) == seen_of(bytes, bytes.size() + 1));
    return 0;
}
