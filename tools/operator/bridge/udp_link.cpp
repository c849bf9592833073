#include "operator/bridge/udp_link.h"

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

bool same(const sockaddr_storage &a, socklen_t a_length, const sockaddr_storage &b, socklen_t b_length)
{
    return a_length == b_length && std::memcmp(&a, &b, a_length) == 0;
}

} // namespace

UdpLink UdpLink::listening(const std::string &address)
{
    return UdpLink(address, true);
}

UdpLink UdpLink::connected(const std::string &address)
{
    return UdpLink(address, false);
}

UdpLink::UdpLink(const std::string &address, bool listen) : learns_(listen)
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
    if (!listen) {
        std::memcpy(&peer_, found->ai_addr, found->ai_addrlen);
        peer_length_ = found->ai_addrlen;
    }
}

UdpLink::UdpLink(UdpLink &&other) noexcept
    : socket_(std::exchange(other.socket_, -1)), learns_(other.learns_), peer_(other.peer_),
      peer_length_(other.peer_length_), sender_(other.sender_), sender_length_(other.sender_length_),
      heard_us_(other.heard_us_)
{
}

UdpLink::~UdpLink()
{
    if (socket_ >= 0) {
        close(socket_);
    }
}

bool UdpLink::send(const std::vector<uint8_t> &bytes)
{
    return has_peer() &&
           sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&peer_),
                  peer_length_) == static_cast<ssize_t>(bytes.size());
}

bool UdpLink::receive(std::vector<uint8_t> &bytes, bool &from_peer)
{
    bytes.resize(most_datagram);
    sender_ = {};
    sender_length_ = sizeof sender_;
    const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr *>(&sender_), &sender_length_);
    if (count < 0) {
        return false;
    }
    bytes.resize(static_cast<size_t>(count));
    from_peer = has_peer() && same(sender_, sender_length_, peer_, peer_length_);
    return true;
}

bool UdpLink::accept_sender(int64_t now_us)
{
    if (!learns_ || (has_peer() && !is_silent(now_us))) {
        return false;
    }
    peer_ = sender_;
    peer_length_ = sender_length_;
    return true;
}

std::string UdpLink::peer_name() const
{
    char host[NI_MAXHOST] = "";
    char port[NI_MAXSERV] = "";
    getnameinfo(reinterpret_cast<const sockaddr *>(&peer_), peer_length_, host, sizeof host, port,
                sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
    return std::string(host) + ":" + port;
}

} // namespace bridge
