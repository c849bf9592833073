/* A ZIP file of a few small files, uncompressed: for what is one thing in two files. */
#ifndef CONSOLE_ZIP_H
#define CONSOLE_ZIP_H

#include <string>
#include <utility>
#include <vector>

namespace console
{

/* Names (plain ones, without folders) and contents. Together below 4 GiB. */
std::string zip_of(const std::vector<std::pair<std::string, std::string>> &files);

} // namespace console

#endif
