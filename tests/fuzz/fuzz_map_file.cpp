/* Map files: behind the head line any text; the checksum of the last line is put right so that the
 * numbers themselves are reached. */
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <unistd.h>
#include <zlib.h>

extern "C" {
#include "store/map_file.h"
}

namespace
{

/* A regular file: links, as those to open descriptors are, are not followed. */
struct MapOnDisk {
    char path[32] = "/tmp/ale-fuzz-map-XXXXXX";
    int file = mkstemp(path);
    ~MapOnDisk()
    {
        unlink(path);
    }
};

void load(const std::string &text)
{
    static const MapOnDisk place;
    const int file = place.file;
    const std::string path = place.path;
    static const auto map = std::make_unique<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ftruncate(file, 0) != 0 ||
        pwrite(file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
        std::abort();
    }
    if (ale_map_file_load(path.c_str(), map.get(), error) == 0 &&
        (map->line_count > ALE_MAP_MAX_LINES || map->corner_count > ALE_MAP_MAX_CORNERS)) {
        std::abort();
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const std::string any(reinterpret_cast<const char *>(data), size);
    load(any);
    const std::string body = "ALE-SLAM map 1\n" + any + "\n";
    const auto crc = static_cast<uint32_t>(
        crc32(0, reinterpret_cast<const Bytef *>(body.data()), static_cast<uInt>(body.size())));
    char end[32];
    std::snprintf(end, sizeof end, "end %d %08" PRIx32 "\n", size ? data[0] % 4 : 0, crc);
    load(body + end);
    return 0;
}
