#include "operator/bridge/udp_socket.h"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include <netdb.h>
#include <unistd.h>

#include "common/command_line/wrong_use.h"

namespace bridge
{

namespace
{

constexpr size_t most_datagram = 65536;

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

/* The C library takes a port modulo 65536. */
bool is_port(const std::string &text)
{
    uint16_t port = 0;
    const char *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, port);
    return error == std::errc() && stop == end;
}

struct HostAndPort {
    std::string host; /* empty: all addresses of this machine */
    std::string port;
};

/* "HOST:PORT" or "PORT"; IPv6 in brackets. */
HostAndPort split(const std::string &address)
{
    const size_t colon = address.rfind(':');
    if (colon == std::string::npos) {
        return {"", address};
    }
    std::string host = address.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
        host = host.substr(1, host.size() - 2);
    }
    return {host, address.substr(colon + 1)};
}

AddressList resolve(const std::string &address, bool listen)
{
    const auto [host, port] = split(address);
    addrinfo hints{};
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICSERV | (listen ? AI_PASSIVE : 0);
    if (!is_port(port) || (!listen && host.empty())) {
        throw cli::WrongUse("no such address: " + address + (listen ? " ([ADDR:]PORT)" : " (HOST:PORT)"));
    }
    addrinfo *found = nullptr;
    const int error = getaddrinfo(host.empty() ? nullptr : host.c_str(), port.c_str(), &hints, &found);
    if (error != 0) {
        throw std::runtime_error(address + ": " + gai_strerror(error));
    }
    return {found, freeaddrinfo};
}

} // namespace

Address Address::of(const std::string &host_and_port)
{
    const AddressList found = resolve(host_and_port, false);
    Address address;
    std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
    address.length = found->ai_addrlen;
    return address;
}

std::string Address::name() const
{
    char host[NI_MAXHOST] = "";
    char port[NI_MAXSERV] = "";
    getnameinfo(reinterpret_cast<const sockaddr *>(&storage), length, host, sizeof host, port, sizeof port,
                NI_NUMERICHOST | NI_NUMERICSERV);
    return std::string(host) + ":" + port;
}

UdpSocket::UdpSocket(const std::string &address, bool listen)
{
    const AddressList found = resolve(address, listen);
    socket_ = socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0 || (listen && bind(socket_, found->ai_addr, found->ai_addrlen) < 0)) {
        const std::string reason = std::strerror(errno);
        if (socket_ >= 0) {
            close(socket_);
        }
        throw std::runtime_error(address + ": " + reason);
    }
}

UdpSocket::UdpSocket(UdpSocket &&other) noexcept : socket_(std::exchange(other.socket_, -1))
{
}

UdpSocket::~UdpSocket()
{
    if (socket_ >= 0) {
        close(socket_);
    }
}

bool UdpSocket::send(const std::vector<uint8_t> &bytes, const Address &to)
{
    return sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&to.storage),
                  to.length) == static_cast<ssize_t>(bytes.size());
}

bool UdpSocket::receive(std::vector<uint8_t> &bytes, Address &from)
{
    bytes.resize(most_datagram);
    from = {};
    from.length = sizeof from.storage;
    const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr *>(&from.storage), &from.length);
    bytes.resize(count < 0 ? 0 : static_cast<size_t>(count));
    return count >= 0;
}

} // namespace bridge
