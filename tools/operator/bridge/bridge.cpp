#include "operator/bridge/bridge.h"

#include <chrono>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <utility>

#include <poll.h>

#include "common/command_line/wrong_use.h"
#include "operator/bridge/frame.h"

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

Bridge::Bridge(const std::string &lcm_url, UdpLink link, const Selection &send, const Selection &accept)
    : wire_(feed::join_lcm(lcm_url)), link_(std::move(link)), send_(send), accept_(accept),
      session_(std::random_device{}())
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

void Bridge::carry_out(const char *channel, const uint8_t *bytes, size_t count)
{
    if (!send_.take(channel, now_us())) {
        counts_.thinned++;
        return;
    }
    Frame frame;
    frame.kind = Kind::message;
    frame.session = session_;
    frame.sequence = sequence_ + 1;
    frame.channel = channel;
    frame.message = bytes;
    frame.size = count;
    const std::vector<uint8_t> datagram = encode(frame);
    if (datagram.empty() || !link_.send(datagram)) {
        counts_.unsent++;
        return;
    }
    sequence_++;
    counts_.sent++;
}

void Bridge::carry_in(const Frame &frame)
{
    if (!accept_.contains(frame.channel)) {
        counts_.refused++;
        return;
    }
    if (arrivals_.take(frame)) {
        ale_wire_send(wire_.get(), frame.channel.c_str(), frame.message, frame.size);
        counts_.received++;
    }
}

void Bridge::receive_datagrams()
{
    bool from_peer = false;
    for (int k = 0; k < most_at_once && link_.receive(datagram_, from_peer); k++) {
        const std::optional<Frame> frame = decode(datagram_.data(), datagram_.size());
        const int64_t now = now_us();
        tell_changes(now); /* that the peer was silent, before another takes its place */
        if (!frame || (!from_peer && !link_.accept_sender(now))) {
            counts_.refused++;
            continue;
        }
        link_.heard(now);
        if (frame->kind == Kind::message) {
            carry_in(*frame);
        }
    }
}

void Bridge::say_hello()
{
    const int64_t now = now_us();
    if (now < hello_us_) {
        return;
    }
    Frame frame;
    frame.session = session_;
    frame.sequence = sequence_;
    link_.send(encode(frame));
    hello_us_ = now + hello_period_us;
}

void Bridge::tell_changes(int64_t now)
{
    const bool up = link_.has_peer() && !link_.is_silent(now);
    if (up != up_) {
        std::fprintf(stderr, "ale-bridge: %s %s\n", link_.peer_name().c_str(),
                     up ? "is there" : "is silent: waiting until it is there again");
    }
    up_ = up;
}

void Bridge::step()
{
    pollfd sources[] = {{ale_wire_descriptor(wire_.get()), POLLIN, 0}, {link_.descriptor(), POLLIN, 0}};
    poll(sources, 2, look_ms);
    if (sources[1].revents != 0) {
        receive_datagrams();
    }
    ale_wire_receive(wire_.get(), 0, most_at_once);
    say_hello();
    tell_changes(now_us());
}

} // namespace bridge
