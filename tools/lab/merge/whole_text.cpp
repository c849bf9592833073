#include "lab/merge/whole_text.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>

#include <zlib.h>

extern "C" {
#include "file/bytes.h"
#include "file/whole_file.h"
}

namespace merge
{

namespace
{

constexpr unsigned rights = 0640;
constexpr int gzip_window = 15 + 16; /* zlib's way to ask for gzip */
constexpr int usual_memory = 8;

[[noreturn]] void fail(const std::string &path, const std::string &why)
{
    throw std::runtime_error(path + ": " + why);
}

} // namespace

std::string read_whole(const std::string &path, Damage damage)
{
    ale_bytes_t bytes{};
    const char *error = ale_bytes_read_file(&bytes, path.c_str());
    if (error) {
        fail(path, error);
    }
    const std::string content(bytes.at, bytes.at + bytes.count);
    const bool cut_short = bytes.cut_short;
    ale_bytes_free(&bytes);
    if (cut_short && damage == Damage::refused) {
        fail(path, "damaged");
    }
    return content;
}

uint32_t checksum_of(std::string_view content)
{
    return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef *>(content.data()), content.size()));
}

uint32_t checksum_of_file(const std::string &path)
{
    return checksum_of(read_whole(path, Damage::cut_off));
}

void write_whole(const std::string &path, const std::string &content)
{
    ale_whole_file_t file;
    if (ale_whole_file_begin(&file, path.c_str(), rights) < 0) {
        fail(path, ale_whole_file_words(errno));
    }
    std::fwrite(content.data(), 1, content.size(), file.out);
    if (ale_whole_file_commit(&file) < 0) {
        fail(path, ale_whole_file_words(errno));
    }
}

std::string packed(const std::string &content)
{
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, usual_memory,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::bad_alloc();
    }
    std::string out;
    std::string piece(size_t{1} << 16U, '\0');
    size_t taken = 0;
    int status = Z_OK;
    while (status == Z_OK) {
        if (stream.avail_in == 0) {
            const size_t next = std::min(piece.size(), content.size() - taken);
            stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(content.data() + taken));
            stream.avail_in = static_cast<uInt>(next);
            taken += next;
        }
        stream.next_out = reinterpret_cast<Bytef *>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        status = deflate(&stream, taken == content.size() ? Z_FINISH : Z_NO_FLUSH);
        out.append(piece, 0, piece.size() - stream.avail_out);
    }
    deflateEnd(&stream);
    return out;
}

} // namespace merge
