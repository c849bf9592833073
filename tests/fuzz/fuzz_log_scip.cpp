/* Bytes from the line inside of intact chunks, then whatever is left as raw file. */
#include <cstdio>

#include "read_log.hpp"

extern "C" {
#include "store/recording.h"
}

namespace
{

std::string intact_chunk(ale_chunk_kind_t kind, const std::string &payload)
{
    char *bytes = nullptr;
    size_t count = 0;
    ale_recording_t recording = {open_memstream(&bytes, &count)};
    ale_recording_write(&recording, kind, 1000000, payload.data(), static_cast<uint32_t>(payload.size()));
    ale_recording_close(&recording);
    std::string out(bytes, count);
    std::free(bytes);
    return out;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t inside = size / 4 * 3;
    const std::string line(reinterpret_cast<const char *>(data), inside);
    const auto kind = static_cast<ale_chunk_kind_t>(size ? 1 + data[0] % 8 : 1);
    const std::string beginning = "ALESCIP1" + intact_chunk(ALE_CHUNK_SENT, "MD0044072501000\n") +
                                  intact_chunk(ALE_CHUNK_RECEIVED, line) + intact_chunk(kind, line);
    ale_test::read_log(beginning, data + inside, size - inside);
    return 0;
}
