/* LCM on one side, the link on the other: what is selected goes out, what is accepted comes in. One thread.
 */
#ifndef BRIDGE_BRIDGE_H
#define BRIDGE_BRIDGE_H

#include <cstdint>
#include <string>
#include <vector>

#include "common/feed/lcm_feed.h"
#include "operator/bridge/arrivals.h"
#include "operator/bridge/selection.h"
#include "operator/bridge/udp_link.h"

namespace bridge
{

struct Counts {
    uint64_t sent = 0;
    uint64_t thinned = 0;
    uint64_t unsent = 0; /* nobody there, too long, or the system refused */
    uint64_t received = 0;
    uint64_t refused = 0; /* no datagram of this link, of a stranger, or on a channel that is not accepted */
};

class Bridge
{
  public:
    /* Throws std::runtime_error when LCM cannot be joined, cli::WrongUse when a channel is both sent
     * and accepted: it would go round for ever. */
    Bridge(const std::string &lcm_url, UdpLink link, const Selection &send, const Selection &accept);

    /* Waits up to 100 ms for something to carry. */
    void step();

    const Counts &counts() const
    {
        return counts_;
    }
    const Arrivals &arrivals() const
    {
        return arrivals_;
    }

  private:
    static void on_message(void *user, const char *channel, const uint8_t *bytes, size_t count) noexcept;
    void carry_out(const char *channel, const uint8_t *bytes, size_t count);
    void carry_in(const Frame &frame);
    void receive_datagrams();
    void say_hello();
    void tell_changes(int64_t now);

    feed::Wire wire_;
    UdpLink link_;
    Selection send_;
    Selection accept_;
    Arrivals arrivals_;
    Counts counts_;
    uint32_t session_;
    uint32_t sequence_ = 0;
    int64_t hello_us_ = 0;
    bool up_ = false;
    std::vector<uint8_t> datagram_;
};

} // namespace bridge

#endif
