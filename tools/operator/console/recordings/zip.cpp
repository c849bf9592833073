#include "operator/console/recordings/zip.h"

#include <cstdint>

#include <zlib.h>

namespace console
{

namespace
{

/* Little endian. */
void put(std::string &out, uint32_t value, int bytes)
{
    for (int k = 0; k < bytes; k++) {
        out.push_back(static_cast<char>(value >> (8 * k) & 0xFF));
    }
}

/* Version, flags, no compression, 1980-01-01, checksum, sizes, length of the name: the same in both places.
 */
void put_facts(std::string &out, const std::string &name, const std::string &content)
{
    const auto *bytes = reinterpret_cast<const unsigned char *>(content.data());
    const auto size = static_cast<uint32_t>(content.size());
    put(out, 10, 2);
    put(out, 0, 4);
    put(out, 0, 2);
    put(out, 1 << 5 | 1, 2);
    put(out, static_cast<uint32_t>(crc32_z(0, bytes, content.size())), 4);
    put(out, size, 4);
    put(out, size, 4);
    put(out, static_cast<uint32_t>(name.size()), 2);
    put(out, 0, 2);
}

} // namespace

std::string zip_of(const std::vector<std::pair<std::string, std::string>> &files)
{
    std::string out;
    std::string directory;
    for (const auto &[name, content] : files) {
        const auto at = static_cast<uint32_t>(out.size());
        out += "PK\3\4";
        put_facts(out, name, content);
        out += name + content;
        directory += "PK\1\2";
        put(directory, 10, 2);
        put_facts(directory, name, content);
        put(directory, 0, 4);
        put(directory, 0, 2);
        put(directory, 0, 4);
        put(directory, at, 4);
        directory += name;
    }
    const auto begin = static_cast<uint32_t>(out.size());
    out += directory + "PK\5\6";
    put(out, 0, 4);
    put(out, static_cast<uint32_t>(files.size()), 2);
    put(out, static_cast<uint32_t>(files.size()), 2);
    put(out, static_cast<uint32_t>(directory.size()), 4);
    put(out, begin, 4);
    put(out, 0, 2);
    return out;
}

} // namespace console
