/* The files that a program was told of, looked at before its work: that a result cannot be written is told
 * before a long replay and not after it, and no result takes the place of what it is made from, or of
 * another.
 *
 *   cli::Files files;
 *   files.reads("LOG", options.log);
 *   files.writes("--map", options.map);
 *
 * Paths that are empty or "-" pass. */
#ifndef ALE_COMMON_COMMAND_LINE_FILES_H
#define ALE_COMMON_COMMAND_LINE_FILES_H

#include <filesystem>
#include <string>
#include <vector>

namespace cli
{

class Files
{
  public:
    void reads(const std::string &option, const std::string &path);
    /* Throws std::runtime_error when there is no such folder or it may not be written, and WrongUse when a
     * file named before is the same. Touches nothing. */
    void writes(const std::string &option, const std::string &path);

  private:
    struct File {
        std::string option;
        std::filesystem::path path;
    };
    std::vector<File> files_;
};

} // namespace cli

#endif
