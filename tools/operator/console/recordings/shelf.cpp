#include "operator/console/recordings/shelf.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>

namespace console
{

namespace
{

constexpr size_t longest_name = 100;
constexpr mode_t folder_rights = 0750;
constexpr mode_t file_rights = 0640;

bool is_plain(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
}

bool ends_with(const std::string &name, const std::string &ending)
{
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace

bool Shelf::may_be_called(const std::string &name) const
{
    return name.size() <= longest_name && ends_with(name, ending_) && name[0] != '.' &&
           std::all_of(name.begin(), name.end(), is_plain);
}

void Shelf::fail(const std::string &name) const
{
    throw std::runtime_error(folder_ + (name.empty() ? "" : "/" + name) + ": " + std::strerror(errno));
}

Descriptor Shelf::open_folder() const
{
    Descriptor folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() < 0 && errno != ENOENT) {
        fail("");
    }
    return folder;
}

std::vector<Listed> Shelf::list() const
{
    const Descriptor folder = open_folder();
    if (folder.number() < 0) {
        return {};
    }
    const std::unique_ptr<DIR, int (*)(DIR *)> entries(fdopendir(dup(folder.number())), closedir);
    if (!entries) {
        fail("");
    }
    std::vector<Listed> found;
    while (const dirent *entry = readdir(entries.get())) {
        struct stat status;
        if (may_be_called(entry->d_name) &&
            fstatat(folder.number(), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(status.st_mode)) {
            found.push_back({entry->d_name, status.st_mtim.tv_sec * 1000 + status.st_mtim.tv_nsec / 1000000,
                             static_cast<uint64_t>(status.st_size)});
        }
    }
    std::sort(found.begin(), found.end(), [](const Listed &a, const Listed &b) {
        return a.changed_ms != b.changed_ms ? a.changed_ms > b.changed_ms : a.name > b.name;
    });
    return found;
}

Descriptor Shelf::open(const std::string &name) const
{
    if (!is_there() || !may_be_called(name)) {
        return Descriptor();
    }
    const Descriptor folder = open_folder();
    if (folder.number() < 0) {
        return Descriptor();
    }
    Descriptor file(openat(folder.number(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (file.number() < 0) {
        if (errno != ENOENT && errno != ELOOP) {
            fail(name);
        }
        return Descriptor();
    }
    struct stat status;
    return fstat(file.number(), &status) == 0 && S_ISREG(status.st_mode) ? std::move(file) : Descriptor();
}

Descriptor Shelf::make(const std::string &name) const
{
    const bool made = mkdir(folder_.c_str(), folder_rights) == 0 || errno == EEXIST;
    const Descriptor folder = made ? open_folder() : Descriptor();
    if (folder.number() < 0) {
        fail("");
    }
    Descriptor file(openat(folder.number(), name.c_str(),
                           O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, file_rights));
    if (file.number() < 0) {
        fail(name);
    }
    return file;
}

} // namespace console
