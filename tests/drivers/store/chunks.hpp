/* Chunks of a recording with their payload, to compare. */
#ifndef TESTS_DRIVERS_STORE_CHUNKS_HPP
#define TESTS_DRIVERS_STORE_CHUNKS_HPP

#include <cstdint>
#include <string>
#include <vector>

extern "C" {
#include "store/recording.h"
}

struct Chunk {
    ale_chunk_kind_t kind;
    int64_t stamp_us;
    std::string payload;
};

/* Those of a recording's bytes; *bad: how many were none. */
inline std::vector<Chunk> chunks_of(const std::string &bytes, uint64_t *bad)
{
    ale_chunk_reader_t reader =
        ale_chunk_reader(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
    std::vector<Chunk> out;
    for (ale_chunk_t chunk; ale_chunk_next(&reader, &chunk);) {
        out.push_back({chunk.kind, chunk.stamp_us,
                       std::string(reinterpret_cast<const char *>(chunk.payload), chunk.length)});
    }
    *bad = reader.bad_chunks;
    return out;
}

#endif
