/* A folder of files that people may ask for by name: recordings (.lcm) or saved maps (.map).
 *
 * A name comes from anybody's browser: it is letters, digits and `.` `_` `-`, does not begin with a dot, and
 * ends as the folder's files do. What is opened is a regular file in the folder itself; links are not
 * followed. */
#ifndef CONSOLE_SHELF_H
#define CONSOLE_SHELF_H

#include <cstdint>
#include <string>
#include <vector>

#include "operator/console/recordings/descriptor.h"

namespace console
{

struct Listed {
    std::string name;
    int64_t changed_ms = 0; /* since 1970 */
    uint64_t bytes = 0;
};

class Shelf
{
  public:
    /* folder empty: there is none. ending: ".lcm". */
    Shelf(std::string folder, std::string ending) : folder_(std::move(folder)), ending_(std::move(ending))
    {
    }

    bool is_there() const
    {
        return !folder_.empty();
    }
    const std::string &folder() const
    {
        return folder_;
    }

    bool may_be_called(const std::string &name) const;

    /* What lies in it, newest first; nothing while the folder is not there. Throws std::runtime_error: the
     * folder and the system's words. */
    std::vector<Listed> list() const;

    /* For reading. None: no such file, or none that may be asked for. Throws as list() when it is there and
     * cannot be read. */
    Descriptor open(const std::string &name) const;

    /* A file that is not there yet, its folder, too, if need be. Throws as list(). */
    Descriptor make(const std::string &name) const;

  private:
    Descriptor open_folder() const; /* none: it is not there */
    [[noreturn]] void fail(const std::string &name) const;

    std::string folder_;
    std::string ending_;
};

} // namespace console

#endif
