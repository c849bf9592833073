/* Maps of tiles: behind the head line any index, whose checksum and count are put right so that the numbers
 * themselves are reached; what it tells of is read from the same bytes. */
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>

#include <unistd.h>
#include <zlib.h>

extern "C" {
#include "store/tile_file.h"
}

namespace
{

constexpr uint32_t tiles_most = 64; /* that are read */

/* A regular file: links, as those to open descriptors are, are not followed. */
struct TilesOnDisk {
    char path[32] = "/tmp/ale-fuzz-tiles-XXXXXX";
    int file = mkstemp(path);
    ~TilesOnDisk()
    {
        unlink(path);
    }
};

void load(const std::string &text)
{
    static const TilesOnDisk place;
    static const auto map = std::make_unique<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    ale_tile_file_t tiles;
    if (ftruncate(place.file, 0) != 0 ||
        pwrite(place.file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
        std::abort();
    }
    if (ale_tile_file_open(&tiles, place.path, error) < 0) {
        return;
    }
    for (uint32_t k = 0; k < tiles.count && k < tiles_most; k++) {
        const ale_tile_entry_t &tile = tiles.tile[k];
        if (ale_tile_file_find(&tiles, tile.x, tile.y) != &tile) {
            std::abort();
        }
        if (ale_tile_file_read(&tiles, &tile, map.get(), error) == 0 &&
            (map->line_count != tile.walls || map->corner_count != tile.corners)) {
            std::abort();
        }
    }
    ale_tile_file_close(&tiles);
}

uint32_t tiles_in(const std::string &index)
{
    std::istringstream lines(index);
    uint32_t count = 0;
    for (std::string line; std::getline(lines, line);) {
        count += line.rfind("tile ", 0) == 0;
    }
    return count;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const std::string any(reinterpret_cast<const char *>(data), size);
    const size_t end_of_index = any.find('\f'); /* behind it: tiles */
    const std::string index = "ALE-SLAM tiles 1\nmap 10000000 9 9\n" + any.substr(0, end_of_index) + "\n";
    const auto crc = static_cast<uint32_t>(
        crc32(0, reinterpret_cast<const Bytef *>(index.data()), static_cast<uInt>(index.size())));
    char end[32];
    std::snprintf(end, sizeof end, "end %" PRIu32 " %08" PRIx32 "\n", tiles_in(index), crc);
    load(any);
    load(index + end + (end_of_index == std::string::npos ? "" : any.substr(end_of_index + 1)));
    return 0;
}
