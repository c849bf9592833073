#include "operator/bridge/bridge.h"

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <poll.h>

#include "common/command_line/wrong_use.h"
#include "operator/bridge/wire_bytes.h"

namespace bridge
{

namespace
{

constexpr int64_t hello_period_us = 500000;
constexpr int look_ms = 100;
constexpr int most_at_once = 256;

int64_t now_us()
{
    using namespace std::chrono;
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

Bridge::Bridge(const std::string &lcm_url, UdpSocket socket, Ends ends, const Selection &send,
               const Selection &accept)
    : wire_(feed::join_lcm(lcm_url)), socket_(std::move(socket)), ends_(std::move(ends)), send_(send),
      accept_(accept)
{
    for (const std::string &channel : send_.names()) {
        if (accept_.contains(channel)) {
            throw cli::WrongUse(channel + " is both sent and accepted: it would go round for ever");
        }
        if (ale_wire_subscribe(wire_.get(), channel.c_str(), on_message, this) < 0) {
            throw std::runtime_error("cannot subscribe to " + channel);
        }
    }
}

void Bridge::on_message(void *user, const char *channel, const uint8_t *bytes, size_t count) noexcept
{
    static_cast<Bridge *>(user)->carry_out(channel, bytes, count);
}

bool Bridge::send_to_all(const Frame &frame)
{
    bool sent = false;
    for (Session &session : ends_.sessions()) {
        const std::vector<uint8_t> datagram = session.seal(frame);
        sent = (!datagram.empty() && socket_.send(datagram, session.address())) || sent;
    }
    return sent;
}

void Bridge::carry_out(const char *channel, const uint8_t *bytes, size_t count)
{
    if (!send_.take(channel, now_us())) {
        counts_.thinned++;
        return;
    }
    Frame frame;
    frame.channel = channel;
    frame.message = bytes;
    frame.size = count;
    (send_to_all(frame) ? counts_.sent : counts_.unsent)++;
}

/* Of an end that has proved who it is. */
bool Bridge::carry_in(const std::vector<uint8_t> &datagram, const Address &from)
{
    Session *session = ends_.of(datagram);
    const auto frame = session ? session->open(datagram, from, now_us()) : std::nullopt;
    if (!frame) {
        return false;
    }
    ends_.confirm(*session);
    if (!frame->channel.empty() && !accept_.contains(frame->channel)) {
        return false;
    }
    if (session->is_in_order(*frame) && !frame->channel.empty()) {
        ale_wire_send(wire_.get(), frame->channel.c_str(), frame->message, frame->size);
        counts_.received++;
    }
    return true;
}

bool Bridge::take(const std::vector<uint8_t> &datagram, const Address &from)
{
    const auto kind = kind_of(datagram);
    if (kind == Kind::data) {
        return carry_in(datagram, from);
    }
    if (kind == Kind::hello) {
        const std::vector<uint8_t> answer = ends_.greet(datagram, from, now_us());
        return !answer.empty() && socket_.send(answer, from);
    }
    const bool greeted = kind == Kind::answer && ends_.greeted(datagram, from, now_us());
    hello_us_ = greeted ? 0 : hello_us_;
    return greeted;
}

void Bridge::receive_datagrams()
{
    Address from;
    for (int k = 0; k < most_at_once && socket_.receive(datagram_, from); k++) {
        counts_.refused += !take(datagram_, from);
    }
}

/* Who is known hears that this end is there; who is looked for, who asks for him. */
void Bridge::say_hello()
{
    const int64_t now = now_us();
    if (now < hello_us_) {
        return;
    }
    hello_us_ = now + hello_period_us;
    send_to_all({});
    const std::vector<uint8_t> hello = ends_.hello();
    if (!hello.empty()) {
        socket_.send(hello, ends_.wanted());
    }
}

void Bridge::step()
{
    pollfd sources[] = {{ale_wire_descriptor(wire_.get()), POLLIN, 0}, {socket_.descriptor(), POLLIN, 0}};
    poll(sources, 2, look_ms);
    if (sources[1].revents != 0) {
        receive_datagrams();
    }
    ale_wire_receive(wire_.get(), 0, most_at_once);
    ends_.forget_silent(now_us());
    say_hello();
}

} // namespace bridge
