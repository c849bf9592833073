/* One UDP socket, and where the other ends are. One thread. */
#ifndef BRIDGE_UDP_SOCKET_H
#define BRIDGE_UDP_SOCKET_H

#include <cstdint>
#include <string>
#include <vector>

#include <sys/socket.h>

namespace bridge
{

struct Address {
    sockaddr_storage storage{};
    socklen_t length = 0;

    /* HOST:PORT. Throws cli::WrongUse for what is no address, std::runtime_error when it is not found. */
    static Address of(const std::string &host_and_port);

    /* "192.168.1.7:7700" */
    std::string name() const;
};

class UdpSocket
{
  public:
    /* [HOST:]PORT to listen on, HOST:PORT to send to. Throws as Address::of, and std::runtime_error when the
     * socket cannot be had. */
    UdpSocket(const std::string &address, bool listen);

    UdpSocket(UdpSocket &&other) noexcept;
    UdpSocket(const UdpSocket &) = delete;
    UdpSocket &operator=(const UdpSocket &) = delete;
    UdpSocket &operator=(UdpSocket &&) = delete;
    ~UdpSocket();

    int descriptor() const
    {
        return socket_;
    }

    /* False: the system refused it. */
    bool send(const std::vector<uint8_t> &bytes, const Address &to);

    /* The next datagram, when one waits; false when none does. */
    bool receive(std::vector<uint8_t> &bytes, Address &from);

  private:
    int socket_ = -1;
};

} // namespace bridge

#endif
