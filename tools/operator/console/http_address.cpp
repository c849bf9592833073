#include "operator/console/http_address.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/command_line/wrong_use.h"

namespace console
{

namespace
{

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

AddressList resolve(const std::string &host, uint16_t port)
{
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo *found = nullptr;
    const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (error != 0) {
        throw cli::WrongUse("--http: no such address: " + host);
    }
    return {found, freeaddrinfo};
}

std::string numeric_host(const addrinfo &address)
{
    char text[NI_MAXHOST] = "";
    getnameinfo(address.ai_addr, address.ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
    return text;
}

std::string without_brackets(const std::string &host)
{
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    return bracketed ? host.substr(1, host.size() - 2) : host;
}

/* Host header without its port. */
std::string name_of(const std::string &host)
{
    const size_t colon = host.rfind(':');
    const size_t bracket = host.rfind(']');
    const bool has_port = colon != std::string::npos && (bracket == std::string::npos || bracket < colon);
    return without_brackets(has_port ? host.substr(0, colon) : host);
}

bool is_ip_address(const std::string &name)
{
    unsigned char bytes[sizeof(in6_addr)];
    return inet_pton(AF_INET, name.c_str(), bytes) == 1 || inet_pton(AF_INET6, name.c_str(), bytes) == 1;
}

} // namespace

std::string HttpAddress::url(const std::string &scheme) const
{
    return scheme + "://" + (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port) + "/";
}

HttpAddress reachable(const HttpAddress &address)
{
    ifaddrs *first = nullptr;
    if ((address.host != "0.0.0.0" && address.host != "::") || getifaddrs(&first) != 0) {
        return address;
    }
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
    for (const ifaddrs *one = first; one != nullptr; one = one->ifa_next) {
        const bool usable = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
                            (one->ifa_flags & IFF_LOOPBACK) == 0 && (one->ifa_flags & IFF_UP) != 0;
        char text[NI_MAXHOST] = "";
        if (usable && getnameinfo(one->ifa_addr, sizeof(sockaddr_in), text, sizeof text, nullptr, 0,
                                  NI_NUMERICHOST) == 0) {
            return {text, address.port, false};
        }
    }
    return address;
}

bool is_loopback(const HttpAddress &address)
{
    return address.ipv6 ? address.host == "::1" : address.host.rfind("127.", 0) == 0;
}

HttpAddress parse_http_address(const std::string &text)
{
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0) {
        throw cli::WrongUse("--http: not of the form ADDR:PORT: " + text);
    }
    const char *end = text.data() + text.size();
    unsigned port = 0;
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, port);
    if (error != std::errc() || rest != end || port > UINT16_MAX) {
        throw cli::WrongUse("--http: no port from 0 to 65535 in " + text);
    }
    const auto found = resolve(without_brackets(text.substr(0, colon)), static_cast<uint16_t>(port));
    return {numeric_host(*found), static_cast<uint16_t>(port), found->ai_family == AF_INET6};
}

void require_free(const HttpAddress &address)
{
    const auto found = resolve(address.host, address.port);
    const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int one = 1;
    const bool listening = fd >= 0 && setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) == 0 &&
                           bind(fd, found->ai_addr, found->ai_addrlen) == 0 && listen(fd, 1) == 0;
    const int reason = errno;
    if (fd >= 0) {
        close(fd);
    }
    if (!listening) {
        throw std::runtime_error("cannot listen at " + address.url() + ": " + std::strerror(reason));
    }
}

void check_origin(const std::string &text)
{
    const size_t start = text.rfind("https://", 0) == 0 ? 8 : text.rfind("http://", 0) == 0 ? 7 : 0;
    if (start == 0 || start == text.size() || text.find_first_of("/?# ", start) != std::string::npos) {
        throw cli::WrongUse("--origin: not of the form https://HOST[:PORT]: " + text);
    }
}

bool origin_is_ours(const std::string &origin, const std::string &host, const Ours &ours)
{
    if (origin.empty() || (!ours.proxy.empty() && origin == ours.proxy)) {
        return true;
    }
    const std::string name = name_of(host);
    const std::string &machine = ours.machine_name;
    const bool known = is_ip_address(name) || name == "localhost" ||
                       (!machine.empty() && (name == machine || name == machine + ".local"));
    return known && origin == ours.scheme + "://" + host;
}

} // namespace console
