/* LCM on one side, the link on the other: what is selected goes out to every other end that has proved who it
 * is, what is accepted comes in from them. One thread. */
#ifndef BRIDGE_BRIDGE_H
#define BRIDGE_BRIDGE_H

#include <cstdint>
#include <string>
#include <vector>

#include "common/feed/lcm_feed.h"
#include "operator/bridge/ends.h"
#include "operator/bridge/selection.h"
#include "operator/bridge/udp_socket.h"

namespace bridge
{

struct Counts {
    uint64_t sent = 0; /* messages, to whom it may be */
    uint64_t thinned = 0;
    uint64_t unsent = 0; /* nobody there, too long, or the system refused */
    uint64_t received = 0;
    uint64_t refused = 0; /* no datagram of this link, of a stranger, played again, or not accepted */
};

class Bridge
{
  public:
    /* Throws std::runtime_error when LCM cannot be joined, cli::WrongUse when a channel is both sent
     * and accepted: it would go round for ever. */
    Bridge(const std::string &lcm_url, UdpSocket socket, Ends ends, const Selection &send,
           const Selection &accept);

    /* Waits up to 100 ms for something to carry. */
    void step();

    const Counts &counts() const
    {
        return counts_;
    }
    const Ends &ends() const
    {
        return ends_;
    }

  private:
    static void on_message(void *user, const char *channel, const uint8_t *bytes, size_t count) noexcept;
    void carry_out(const char *channel, const uint8_t *bytes, size_t count);
    bool carry_in(const std::vector<uint8_t> &datagram, const Address &from);
    bool take(const std::vector<uint8_t> &datagram, const Address &from);
    void receive_datagrams();
    void say_hello();
    bool send_to_all(const Frame &frame);

    feed::Wire wire_;
    UdpSocket socket_;
    Ends ends_;
    Selection send_;
    Selection accept_;
    Counts counts_;
    int64_t hello_us_ = 0;
    std::vector<uint8_t> datagram_;
};

} // namespace bridge

#endif
