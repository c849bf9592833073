/* LCM in for programs that watch the robot: decoded messages, or a count of what could not be decoded.
 *
 *   feed::LcmFeed feed("");                                  (throws std::runtime_error)
 *   feed.on<ale::pose_t>("ALE_POSE", [&](const ale::pose_t &pose) { ... });
 *   while (feed.wait(100)) ...
 *
 * Anybody on the network may send anything: a message whose counts do not fit its bytes makes the generated
 * decoder throw, and the exception must not pass through the C library. One thread owns a feed. */
#ifndef ALE_COMMON_FEED_LCM_FEED_H
#define ALE_COMMON_FEED_LCM_FEED_H

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

extern "C" {
#include "lcm/wire.h"
}

namespace feed
{

using Wire = std::unique_ptr<ale_wire_t, decltype(&ale_wire_close)>;

/* Empty url: the environment's LCM_DEFAULT_URL, else LCM's own default. Throws std::runtime_error. */
inline Wire join_lcm(const std::string &url)
{
    char error[ALE_LCM_URL_ERROR];
    Wire wire(ale_wire_open(url.c_str(), error), ale_wire_close);
    if (!wire) {
        throw std::runtime_error(error);
    }
    return wire;
}

class LcmFeed
{
  public:
    /* url: as join_lcm. */
    explicit LcmFeed(const std::string &url) : wire_(join_lcm(url))
    {
    }

    template <class Message> void on(const std::string &channel, std::function<void(const Message &)> handler)
    {
        receivers_.push_back([handler](const uint8_t *bytes, size_t count) {
            Message message;
            if (count > static_cast<size_t>(std::numeric_limits<int>::max()) ||
                message.decode(bytes, 0, static_cast<int>(count)) < 0) {
                throw std::runtime_error("truncated, or of another type");
            }
            handler(message);
        });
        subscribe(channel);
    }

    /* The same with the bytes as they came: for what is looked at before it is decoded. */
    void on_bytes(const std::string &channel, std::function<void(const uint8_t *, size_t)> handler)
    {
        receivers_.push_back(std::move(handler));
        subscribe(channel);
    }

    /* Waits for one message and handles it. False when the time is over or a signal came; throws when LCM
     * fails. */
    bool wait(int timeout_ms)
    {
        return receive(timeout_ms, 1) > 0;
    }

    /* Handles what has come already, however many datagrams of other channels lie before it. No more than the
     * kernel may have kept until now: whoever floods the bus does not hold up the caller. */
    void drain()
    {
        receive(0, most_kept);
    }

    /* Who sent the message that is just being handled (ale_wire_sender). */
    uint64_t sender() const
    {
        return ale_wire_sender(wire_.get());
    }

    /* Messages that could not be decoded or made no sense. */
    uint64_t malformed() const
    {
        return malformed_;
    }

    /* These, and datagrams that are no messages. */
    uint64_t refused() const
    {
        return malformed_ + ale_wire_dropped(wire_.get()).malformed;
    }

  private:
    struct Subscription {
        LcmFeed *feed;
        size_t receiver;
    };

    /* Empty datagrams in a queue of 4 MiB, with what each costs the kernel. */
    static constexpr int most_kept = 8192;

    int receive(int timeout_ms, int most)
    {
        const int handled = ale_wire_receive(wire_.get(), timeout_ms, most);
        if (handled < 0) {
            throw std::runtime_error("LCM stopped receiving");
        }
        return handled;
    }

    void subscribe(const std::string &channel)
    {
        subscriptions_.push_back(std::make_unique<Subscription>(Subscription{this, receivers_.size() - 1}));
        if (ale_wire_subscribe(wire_.get(), channel.c_str(), take, subscriptions_.back().get()) < 0) {
            throw std::runtime_error("cannot subscribe to " + channel + ": " + std::strerror(errno));
        }
    }

    static void take(void *user, const char *, const uint8_t *bytes, size_t count) noexcept
    {
        const auto *subscription = static_cast<const Subscription *>(user);
        try {
            subscription->feed->receivers_[subscription->receiver](bytes, count);
        } catch (const std::exception &) {
            subscription->feed->malformed_++;
        }
    }

    std::vector<std::function<void(const uint8_t *, size_t)>> receivers_;
    std::vector<std::unique_ptr<Subscription>> subscriptions_;
    uint64_t malformed_ = 0;
    Wire wire_;
};

} // namespace feed

#endif
