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

    /* "http://127.0.0.1:8080/", or with another scheme. */
    std::string url(const std::string &scheme = "http") const;
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

/* Throws cli::WrongUse: not of the form http://HOST[:PORT] or https://HOST[:PORT]. */
void check_origin(const std::string &text);

/* How browsers see our page. */
struct Ours {
    std::string scheme; /* "http" or "https" */
    std::string machine_name;
    std::string proxy; /* "https://robot.example": where a proxy shows the page; empty: there is none */
};

/* Whether a web socket with these Origin and Host headers comes from our own page (or, origin empty, from a
 * program that is no browser). The host must be an IP address, localhost or this machine's name: a foreign
 * name that was made to resolve to us (DNS rebinding) is refused. What a proxy shows is ours whatever it
 * makes of the Host. */
bool origin_is_ours(const std::string &origin, const std::string &host, const Ours &ours);

} // namespace console

#endif
