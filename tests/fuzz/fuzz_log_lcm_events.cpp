/* Messages inside of intact events, with the right fingerprint, then whatever is left as raw file. */
#include <lcmtypes_ale_odometry_t.h>
#include <lcmtypes_ale_scan_t.h>

#include "read_log.hpp"

namespace
{

std::string big_endian(uint64_t value, unsigned bytes)
{
    std::string out;
    for (unsigned i = bytes; i-- > 0;) {
        out += static_cast<char>(value >> (8 * i));
    }
    return out;
}

std::string event(const std::string &channel, int64_t fingerprint, const std::string &message)
{
    return "\xED\xA1\xDA\x01" + std::string(16, '\0') + big_endian(channel.size(), 4) +
           big_endian(message.size() + 8, 4) + channel + big_endian(static_cast<uint64_t>(fingerprint), 8) +
           message;
}

/* A message ends where its own counts say: the forged one is padded to that length if it is not too far. */
std::string padded_scan(std::string message)
{
    message.resize(message.size() < 52 ? 52 : message.size());
    const unsigned ranges = static_cast<unsigned char>(message[50]) % 5U;
    message.replace(48, 4, big_endian(ranges, 4));
    message.resize(52 + 2 * ranges + 2);
    return message + big_endian(ranges, 4) + std::string(ranges, '\x81');
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t inside = size / 4 * 3;
    const std::string message(reinterpret_cast<const char *>(data), inside);
    const int64_t scan = __lcmtypes_ale_scan_t_get_hash();
    const std::string beginning = event("ALE_SCAN", scan, message) +
                                  event("ALE_SCAN", scan, padded_scan(message)) +
                                  event("ALE_ODOMETRY", __lcmtypes_ale_odometry_t_get_hash(), message);
    ale_test::read_log(beginning, data + inside, size - inside);
    return 0;
}
