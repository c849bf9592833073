/* LCM's datagrams, good ones and such as an attacker would make, and a socket that sends them as they are. */
#ifndef TESTS_DRIVERS_LCM_DATAGRAMS_HPP
#define TESTS_DRIVERS_LCM_DATAGRAMS_HPP

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace datagrams
{

using Bytes = std::vector<uint8_t>;

inline void put(Bytes &bytes, uint64_t number, int size)
{
    for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<uint8_t>(number >> shift));
    }
}

inline void put(Bytes &bytes, const std::string &text)
{
    bytes.insert(bytes.end(), text.begin(), text.end());
}

inline Bytes whole(const std::string &channel, const std::string &message, uint32_t sequence = 1)
{
    Bytes bytes;
    put(bytes, "LC02");
    put(bytes, sequence, 4);
    put(bytes, channel + '\0' + message);
    return bytes;
}

struct Part {
    uint32_t sequence = 1;
    uint32_t size = 0;
    uint32_t offset = 0;
    uint16_t number = 0;
    uint16_t of = 1;
};

/* rest: of the first part with the channel and its end. */
inline Bytes part(const Part &p, const std::string &rest)
{
    Bytes bytes;
    put(bytes, "LC03");
    put(bytes, p.sequence, 4);
    put(bytes, p.size, 4);
    put(bytes, p.offset, 4);
    put(bytes, p.number, 2);
    put(bytes, p.of, 2);
    put(bytes, rest);
    return bytes;
}

/* A number as an attacker likes it: at the edges of 32 bits, of what is allowed, or any. */
inline uint32_t hostile_number(std::mt19937 &random)
{
    const uint32_t edges[] = {0,          1,          2,          19,         31,         32,
                              1000,       65535,      65536,      65537,      0x0fffffff, 0x10000000,
                              0x10000001, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff};
    const auto choice = random() % 20;
    return choice < 17 ? edges[choice] : static_cast<uint32_t>(random());
}

/* One of all kinds: parts with hostile numbers, channels without an end, cut and garbled datagrams, noise. */
inline Bytes hostile(std::mt19937 &random, const std::string &channel)
{
    const std::string message(random() % 100, 'x');
    const Part numbers = {static_cast<uint32_t>(random() % 4), hostile_number(random), hostile_number(random),
                          static_cast<uint16_t>(random() % 3), static_cast<uint16_t>(random() % 4)};
    Bytes bytes;
    switch (random() % 5) {
    case 0:
        return part(numbers, channel + '\0' + message);
    case 1:
        bytes = whole(channel, message);
        bytes.resize(random() % (bytes.size() + 1));
        return bytes;
    case 2:
        return whole(std::string(random() % 200, 'C'), "");
    case 3:
        bytes = part(numbers, channel + '\0' + message);
        bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1 << random() % 8);
        bytes.resize(random() % (bytes.size() + 1));
        return bytes;
    default:
        for (auto left = random() % 300; left > 0; left--) {
            bytes.push_back(static_cast<uint8_t>(random()));
        }
        return bytes;
    }
}

/* Sends to the group of a URL, and to this machine only. */
class Sender
{
  public:
    explicit Sender(const std::string &url) : socket_(socket(AF_INET, SOCK_DGRAM, 0))
    {
        const auto colon = url.rfind(':');
        to_.sin_family = AF_INET;
        to_.sin_port = htons(static_cast<uint16_t>(std::stoi(url.substr(colon + 1))));
        to_.sin_addr.s_addr = inet_addr(url.substr(7, colon - 7).c_str());
        const int here = 0;
        if (socket_ < 0 || setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &here, sizeof here) < 0) {
            throw std::runtime_error("no socket");
        }
    }
    ~Sender()
    {
        close(socket_);
    }
    Sender(const Sender &) = delete;
    Sender &operator=(const Sender &) = delete;

    void send(const Bytes &bytes) const
    {
        sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&to_), sizeof to_);
    }

  private:
    int socket_;
    sockaddr_in to_{};
};

} // namespace datagrams

#endif
