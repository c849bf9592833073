#include "operator/console/token.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

extern "C" {
#include "file/bytes.h"
}

namespace console
{

namespace
{

constexpr size_t least = 12;
constexpr size_t longest = 128;

[[noreturn]] void fail(const std::string &path, const std::string &reason)
{
    throw std::runtime_error(path + ": " + reason);
}

std::string read_token(const std::string &path)
{
    ale_bytes_t bytes;
    struct stat status = {};
    const ale_bytes_rule_t rule = {2 * longest, true};
    const char *wrong = ale_bytes_read_regular(&bytes, path.c_str(), &rule, &status);
    if (wrong != nullptr) {
        fail(path, wrong);
    }
    std::string text(reinterpret_cast<const char *>(bytes.at), bytes.count);
    ale_bytes_free(&bytes);
    if (status.st_uid != 0 && status.st_uid != geteuid()) {
        fail(path, "belongs to another user, who knows the token: it must be root's or your own (chown)");
    }
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
        fail(path, "readable by others: no longer secret (chmod 600)");
    }
    text.erase(text.find_last_not_of("\r\n") + 1);
    if (!is_token(text)) {
        fail(path, "no token of 12 to 128 letters and digits");
    }
    return text;
}

/* False when somebody else has made it meanwhile. The file has its name when it is whole. */
bool make_token(const std::string &path)
{
    const std::string unfinished = path + "." + std::to_string(getpid());
    const std::string line = random_token() + "\n";
    const int file =
        open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file < 0) {
        fail(path, std::strerror(errno));
    }
    errno = 0;
    bool made = write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    int reason = made || errno != 0 ? errno : ENOSPC;
    close(file);
    if (made) {
        made = link(unfinished.c_str(), path.c_str()) == 0;
        reason = errno;
    }
    unlink(unfinished.c_str());
    if (!made && reason != EEXIST) {
        fail(path, std::strerror(reason));
    }
    return made;
}

} // namespace

bool is_token(const std::string &text)
{
    return text.size() >= least && text.size() <= longest &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
}

std::string random_token()
{
    unsigned char random[16];
    char hex[2 * sizeof random + 1];
    randombytes_buf(random, sizeof random);
    return sodium_bin2hex(hex, sizeof hex, random, sizeof random);
}

std::string token_of_file(const std::string &path)
{
    if (access(path.c_str(), F_OK) < 0) {
        make_token(path);
    }
    return read_token(path);
}

std::string usual_token_file()
{
    namespace fs = std::filesystem;
    const char *state = std::getenv("XDG_STATE_HOME");
    const char *home = std::getenv("HOME");
    if ((state == nullptr || *state == '\0') && (home == nullptr || *home == '\0')) {
        return {};
    }
    const fs::path folder =
        (state != nullptr && *state != '\0' ? fs::path(state) : fs::path(home) / ".local/state") / "ale-slam";
    std::error_code failed;
    fs::create_directories(folder.parent_path(), failed);
    return mkdir(folder.c_str(), S_IRWXU) == 0 || errno == EEXIST ? (folder / "console.token").string() : "";
}

void hide_in_arguments(const std::string &token, int argc, char **argv)
{
    for (int k = 1; k < argc; k++) {
        char *found = std::strstr(argv[k], token.c_str());
        if (found != nullptr) {
            std::memset(found, '*', token.size());
        }
    }
}

} // namespace console
