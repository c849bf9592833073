/* One UDP socket with one other end. The end that listens learns who the other is from what arrives; it takes
 * another one when this one has been silent for a while. One thread. */
#ifndef BRIDGE_UDP_LINK_H
#define BRIDGE_UDP_LINK_H

#include <cstdint>
#include <string>
#include <vector>

#include <sys/socket.h>

namespace bridge
{

constexpr int64_t silence_us = 3000000;

class UdpLink
{
  public:
    /* address: [HOST:]PORT to listen on, HOST:PORT to connect to. Throws cli::WrongUse for what is no
     * address and std::runtime_error when the socket cannot be had. */
    static UdpLink listening(const std::string &address);
    static UdpLink connected(const std::string &address);

    UdpLink(UdpLink &&other) noexcept;
    UdpLink(const UdpLink &) = delete;
    UdpLink &operator=(const UdpLink &) = delete;
    UdpLink &operator=(UdpLink &&) = delete;
    ~UdpLink();

    int descriptor() const
    {
        return socket_;
    }

    /* Whether there is somebody to send to. */
    bool has_peer() const
    {
        return peer_length_ > 0;
    }

    /* False: nobody there, or the system refused it. */
    bool send(const std::vector<uint8_t> &bytes);

    /* The next datagram, when one waits; false when none does. `from_peer`: of the other end. A datagram of a
     * stranger is for accept_sender. */
    bool receive(std::vector<uint8_t> &bytes, bool &from_peer);

    /* The sender of the last datagram, which was a valid one, is the other end from now on, when there is
     * none or it is silent. True: it is. */
    bool accept_sender(int64_t now_us);

    /* Something valid was heard of the other end. */
    void heard(int64_t now_us)
    {
        heard_us_ = now_us;
    }
    bool is_silent(int64_t now_us) const
    {
        return heard_us_ == 0 || now_us - heard_us_ > silence_us;
    }

    /* "192.168.1.7:7700" */
    std::string peer_name() const;

  private:
    UdpLink(const std::string &address, bool listen);

    int socket_ = -1;
    bool learns_ = false;
    sockaddr_storage peer_{};
    socklen_t peer_length_ = 0;
    sockaddr_storage sender_{};
    socklen_t sender_length_ = 0;
    int64_t heard_us_ = 0;
};

} // namespace bridge

#endif
