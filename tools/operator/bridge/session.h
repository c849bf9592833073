/* One other end that has proved who it is: datagrams sealed for it, and opened that are its own.
 *
 *   head | session (8) | sequence (8) | sealed frame        (ChaCha20-Poly1305; the head is covered, too)
 *
 * The sequence is the nonce. It counts the datagrams of one way from 1, and only a datagram with a right seal
 * moves what is known of it; each is taken once, in any order within the last 1024. */
#ifndef BRIDGE_SESSION_H
#define BRIDGE_SESSION_H

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "operator/bridge/arrivals.h"
#include "operator/bridge/frame.h"
#include "operator/bridge/handshake.h"
#include "operator/bridge/udp_socket.h"

namespace bridge
{

constexpr int64_t silence_us = 3000000;

/* Which session the bytes say to be of; nothing when they are no data of this link. */
std::optional<uint64_t> session_of(const std::vector<uint8_t> &bytes);

class Session
{
  public:
    Session(uint64_t number, std::string name, const SessionKeys &keys, const Address &address)
        : number_(number), name_(std::move(name)), keys_(keys), address_(address)
    {
    }

    /* Empty: the frame is too long. */
    std::vector<uint8_t> seal(const Frame &frame);

    /* Nothing: not sealed for this session, or taken before. The frame lies in the session until the next one
     * is opened. What is newer than all before also tells where the other end is now. */
    std::optional<Frame> open(const std::vector<uint8_t> &bytes, const Address &from, int64_t now_us);

    /* Whether what was opened last is not older than what came before on its channel. */
    bool is_in_order(const Frame &frame)
    {
        return arrivals_.take(frame.channel, opened_);
    }

    uint64_t number() const
    {
        return number_;
    }
    const std::string &name() const
    {
        return name_;
    }
    const Address &address() const
    {
        return address_;
    }
    const Arrivals &arrivals() const
    {
        return arrivals_;
    }

    /* Something was opened: the other end has the keys. */
    bool is_confirmed() const
    {
        return newest_ > 0;
    }
    bool is_silent(int64_t now_us) const
    {
        return now_us - heard_us_ > silence_us;
    }
    void wait_from(int64_t now_us)
    {
        heard_us_ = now_us;
    }

  private:
    static constexpr size_t window = 1024;

    bool is_new(uint64_t sequence) const;
    void note(uint64_t sequence);

    uint64_t number_;
    std::string name_;
    SessionKeys keys_;
    Address address_;
    Arrivals arrivals_;
    uint64_t sent_ = 0;
    uint64_t newest_ = 0;
    uint64_t opened_ = 0;
    std::bitset<window> taken_; /* of the last sequences, by their rest */
    int64_t heard_us_ = 0;
    std::vector<uint8_t> plain_;
};

} // namespace bridge

#endif
