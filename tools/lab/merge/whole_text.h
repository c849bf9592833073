/* Files that are read and written at once, whole or not at all, packed where that pays. Each throws
 * std::runtime_error with one line that names the file. */
#ifndef ALE_LAB_MERGE_WHOLE_TEXT_H
#define ALE_LAB_MERGE_WHOLE_TEXT_H

#include <cstdint>
#include <string>
#include <string_view>

namespace merge
{

/* The content, unpacked (gzip, bzip2). A packed file that is cut or damaged is refused, or, of a log, read up
 * to there. */
enum class Damage { refused, cut_off };
std::string read_whole(const std::string &path, Damage damage = Damage::refused);

/* CRC-32 (zlib's). Of a file: of all that can be read of it, unpacked. */
uint32_t checksum_of(std::string_view content);
uint32_t checksum_of_file(const std::string &path);

/* Rights 0640. Whatever happens, the path holds what it held or the new content: drivers/file/whole_file.h.
 */
void write_whole(const std::string &path, const std::string &content);

/* As gzip packs it; the same content gives the same bytes. Throws std::bad_alloc. */
std::string packed(const std::string &content);

} // namespace merge

#endif
