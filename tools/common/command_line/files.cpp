#include "common/command_line/files.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <unistd.h>

#include "common/command_line/wrong_use.h"

namespace cli
{

namespace fs = std::filesystem;

namespace
{

bool is_a_file(const std::string &path)
{
    return !path.empty() && path != "-";
}

[[noreturn]] void fail(const fs::path &path, int error)
{
    throw std::runtime_error(path.string() + ": " + std::strerror(error));
}

void require_writable(const fs::path &path)
{
    std::error_code unknown;
    const fs::file_status status = fs::status(path, unknown);
    if (fs::is_directory(status)) {
        fail(path, EISDIR);
    }
    if (fs::exists(status)) {
        if (access(path.c_str(), W_OK) < 0) {
            fail(path, errno);
        }
        return;
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (access((folder / "").c_str(), W_OK | X_OK) < 0) {
        fail(path, errno);
    }
}

/* By name, or by link; devices may be named as often as wanted. */
bool are_the_same(const fs::path &a, const fs::path &b)
{
    std::error_code unknown;
    const fs::file_status status = fs::status(a, unknown);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        return false;
    }
    return fs::equivalent(a, b, unknown) ||
           fs::weakly_canonical(fs::absolute(a), unknown) == fs::weakly_canonical(fs::absolute(b), unknown);
}

} // namespace

void Files::reads(const std::string &option, const std::string &path)
{
    if (is_a_file(path)) {
        files_.push_back({option, path});
    }
}

void Files::writes(const std::string &option, const std::string &path)
{
    if (!is_a_file(path)) {
        return;
    }
    require_writable(path);
    for (const File &other : files_) {
        if (are_the_same(path, other.path)) {
            throw WrongUse(option + " " + path + ": is the file of " + other.option);
        }
    }
    files_.push_back({option, path});
}

} // namespace cli
