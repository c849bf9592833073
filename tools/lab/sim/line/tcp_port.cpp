#include "lab/sim/line/tcp_port.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/sockios.h>

namespace sim
{

namespace
{

constexpr int64_t longest_wait_us = 1000000;

[[noreturn]] void fail(int number)
{
    throw std::system_error(errno, std::generic_category(), "--tcp " + std::to_string(number));
}

void set(int fd, int level, int option)
{
    const int yes = 1;
    setsockopt(fd, level, option, &yes, sizeof yes);
}

timespec time_of(int64_t us)
{
    return {us / 1000000, us % 1000000 * 1000};
}

} // namespace

TcpPort::TcpPort(int number) : number_(number)
{
    plug();
}

TcpPort::~TcpPort()
{
    unplug();
}

void TcpPort::plug()
{
    const int listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (listener < 0) {
        fail(number_);
    }
    set(listener, SOL_SOCKET, SO_REUSEADDR);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(number_));
    socklen_t size = sizeof address;
    auto *any = reinterpret_cast<sockaddr *>(&address);
    if (bind(listener, any, size) != 0 || listen(listener, 1) != 0 ||
        getsockname(listener, any, &size) != 0) {
        const int error = errno;
        close(listener);
        errno = error;
        fail(number_);
    }
    number_ = ntohs(address.sin_port);
    listener_ = listener;
}

void TcpPort::hang_up()
{
    if (client_ >= 0) {
        close(client_);
        client_ = -1;
    }
}

void TcpPort::unplug()
{
    hang_up();
    if (plugged()) {
        close(listener_);
        listener_ = -1;
    }
}

void TcpPort::accept_client()
{
    if (plugged() && !connected()) {
        client_ = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (connected()) {
            set(client_, IPPROTO_TCP, TCP_NODELAY);
        }
    }
}

std::string TcpPort::read()
{
    accept_client();
    std::string bytes;
    char buffer[512];
    ssize_t got = -1;
    while (connected() && (got = recv(client_, buffer, sizeof buffer, 0)) > 0) {
        bytes.append(buffer, static_cast<size_t>(got));
    }
    if (connected() && (got == 0 || (errno != EAGAIN && errno != EINTR))) {
        hang_up();
    }
    return bytes;
}

size_t TcpPort::write(const std::string &bytes, int64_t)
{
    if (!connected()) {
        return bytes.size();
    }
    const ssize_t sent = send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return sent > 0 ? static_cast<size_t>(sent) : 0;
}

bool TcpPort::client_has_to_read() const
{
    int count = 0;
    return connected() && ioctl(client_, SIOCOUTQ, &count) == 0 && count > 0;
}

void TcpPort::wait(int64_t timeout_us, int other) const
{
    const timespec timeout = time_of(std::clamp<int64_t>(timeout_us, 0, longest_wait_us));
    pollfd lines[2] = {{connected() ? client_ : listener_, POLLIN, 0}, {other, POLLIN, 0}};
    ppoll(lines, 2, &timeout, nullptr);
}

} // namespace sim
