/* Where the console listens, and from which pages it accepts a web socket. */
#ifndef CONSOLE_HTTP_ADDRESS_H
#define CONSOLE_HTTP_ADDRESS_H

#include <cstdint>
#include <string>

namespace console
{

struct HttpAddress {
    std::string host; /* numeric; IPv6 without brackets */
    uint16_t port = 0;
    bool ipv6 = false;

    /* "http://127.0.0.1:8080/" */
    std::string url() const;
};

/* What others can type for an address that stands for all of this machine's: the first that is not the
 * loopback. Other addresses, and those of a machine without a network, as they are. */
HttpAddress reachable(const HttpAddress &address);

/* Whether only this machine reaches it. */
bool is_loopback(const HttpAddress &address);

/* ADDR:PORT, e.g. 127.0.0.1:8080, localhost:8080, [::1]:8080, 0.0.0.0:0 (port 0: any free one).
 * Throws cli::WrongUse saying what is wrong with it. */
HttpAddress parse_http_address(const std::string &text);

/* Throws std::runtime_error naming the address and the reason when nobody can listen there now. */
void require_free(const HttpAddress &address);

/* Whether a web socket with these Origin and Host headers comes from our own page (or, origin empty, from a
 * program that is no browser). The host must be an IP address, localhost or this machine's name: a foreign
 * name that was made to resolve to us (DNS rebinding) is refused. */
bool origin_is_ours(const std::string &origin, const std::string &host, const std::string &machine_name);

} // namespace console

#endif
