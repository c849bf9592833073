#include "lab/sim/line/pty.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

namespace sim
{

namespace
{

/* A client sets its own mode at once. One that does not (a person with `cat`) gets a raw line after this. */
constexpr int64_t patience_us = 50000;
/* How often to look for a client while the port is not open. */
constexpr int64_t lookout_us = 2000;

[[noreturn]] void fail(const std::string &what)
{
    throw std::runtime_error(what + ": " + std::strerror(errno));
}

int open_master()
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) {
        fail("cannot open a pseudo terminal");
    }
    return master;
}

std::string client_path(int master)
{
    char path[64];
    if (const int error = ptsname_r(master, path, sizeof path)) {
        throw std::system_error(error, std::generic_category(), "pseudo terminal");
    }
    return path;
}

/* Once opened and closed, the kernel says when nobody holds the client's end. */
void touch(const std::string &path)
{
    const int client = open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (client < 0) {
        fail(path);
    }
    close(client);
}

void point_link(const std::string &link, const std::string &target)
{
    struct stat status = {};
    if (lstat(link.c_str(), &status) == 0 && !S_ISLNK(status.st_mode)) {
        throw std::runtime_error("--pty " + link + ": is there already and is no symbolic link");
    }
    const std::string next = link + ".new" + std::to_string(getpid());
    unlink(next.c_str());
    if (symlink(target.c_str(), next.c_str()) != 0 || rename(next.c_str(), link.c_str()) != 0) {
        const int error = errno;
        unlink(next.c_str());
        throw std::runtime_error("--pty " + link + ": " + std::strerror(error));
    }
}

/* Another simulator may have taken the link over: then it is not ours to remove. */
void remove_link(const std::string &link, const std::string &target)
{
    char held[256];
    const ssize_t count = readlink(link.c_str(), held, sizeof held);
    if (count > 0 && std::string(held, static_cast<size_t>(count)) == target) {
        unlink(link.c_str());
    }
}

timespec time_of(int64_t us)
{
    return {us / 1000000, us % 1000000 * 1000};
}

} // namespace

Pty::Pty(std::string link) : link_(std::move(link))
{
    plug();
}

Pty::~Pty()
{
    unplug();
}

void Pty::plug()
{
    const int master = open_master();
    try {
        path_ = client_path(master);
        touch(path_);
        point_link(link_, path_);
    } catch (...) {
        close(master);
        throw;
    }
    master_ = master;
    cooked_since_us_ = -1;
}

void Pty::unplug()
{
    if (plugged()) {
        remove_link(link_, path_);
        close(master_);
        master_ = -1;
    }
}

bool Pty::connected() const
{
    pollfd line = {master_, POLLIN, 0};
    return plugged() && poll(&line, 1, 0) >= 0 && (line.revents & POLLHUP) == 0;
}

bool Pty::client_has_to_read() const
{
    const int client = open(path_.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    int count = 0;
    if (client >= 0) {
        ioctl(client, FIONREAD, &count);
        close(client);
    }
    return count > 0;
}

std::string Pty::read()
{
    std::string bytes;
    char buffer[512];
    for (ssize_t got; plugged() && (got = ::read(master_, buffer, sizeof buffer)) > 0;) {
        bytes.append(buffer, static_cast<size_t>(got));
    }
    return bytes;
}

/* False while the client has still to choose its mode: what is sent then would be echoed back. */
bool Pty::make_raw(int64_t host_us)
{
    termios mode = {};
    if (tcgetattr(master_, &mode) != 0 || (mode.c_lflag & ICANON) == 0) {
        cooked_since_us_ = -1;
        return true;
    }
    if (cooked_since_us_ < 0) {
        cooked_since_us_ = host_us;
    }
    if (host_us - cooked_since_us_ < patience_us) {
        return false;
    }
    cfmakeraw(&mode);
    tcsetattr(master_, TCSANOW, &mode);
    return true;
}

size_t Pty::write(const std::string &bytes, int64_t host_us)
{
    if (!connected()) {
        cooked_since_us_ = -1;
        return bytes.size();
    }
    if (!make_raw(host_us)) {
        return 0;
    }
    const ssize_t sent = ::write(master_, bytes.data(), bytes.size());
    return sent > 0 ? static_cast<size_t>(sent) : 0;
}

void Pty::wait(int64_t timeout_us, int other) const
{
    const bool open = connected();
    const timespec timeout = time_of(std::clamp<int64_t>(timeout_us, 0, open ? 1000000 : lookout_us));
    pollfd lines[2] = {{open ? master_ : -1, POLLIN, 0}, {other, POLLIN, 0}};
    ppoll(lines, 2, &timeout, nullptr);
}

} // namespace sim
