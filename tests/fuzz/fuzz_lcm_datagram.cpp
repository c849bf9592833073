/* Datagrams of LCM, one after the other: each is its length in two bytes and that many, from one of four
 * senders. A message that is put together of parts is no longer than they were. */
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>

extern "C" {
#include "lcm/assembly.h"
}

namespace
{

void take(ale_assembly_t &assembly, const uint8_t *bytes, size_t count)
{
    ale_datagram_t datagram;
    if (ale_datagram_read(bytes, count, &datagram) < 0) {
        return;
    }
    if (datagram.count > count ||
        (datagram.channel && std::strlen(datagram.channel) > ALE_DATAGRAM_CHANNEL)) {
        std::abort();
    }
    if (datagram.is_part) {
        const ale_partial_t *whole = ale_assembly_add(&assembly, count % 4, &datagram);
        if (whole && (whole->filled != whole->size || whole->filled > ALE_ASSEMBLY_BYTES)) {
            std::abort();
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const auto assembly = std::make_unique<ale_assembly_t>();
    for (auto &partial : assembly->partial) {
        partial.of = 0;
    }
    while (size >= 2) {
        const size_t stated = static_cast<size_t>(data[0]) << 8 | data[1];
        const size_t count = stated < size - 2 ? stated : size - 2;
        take(*assembly, data + 2, count);
        data += 2 + count;
        size -= 2 + count;
    }
    return 0;
}
