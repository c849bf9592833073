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
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <lcm/lcm.h>

extern "C" {
#include "lcm/url.h"
}

namespace feed
{

using Lcm = std::unique_ptr<lcm_t, decltype(&lcm_destroy)>;

/* Empty url: the environment's LCM_DEFAULT_URL, else LCM's own default. Throws std::runtime_error. */
inline Lcm join_lcm(const std::string &url)
{
    char error[ALE_LCM_URL_ERROR];
    const char *chosen = ale_lcm_url(url.c_str(), error);
    if (!chosen) {
        throw std::runtime_error(error);
    }
    Lcm lcm(lcm_create(chosen), lcm_destroy);
    if (!lcm) {
        throw std::runtime_error(std::string("LCM: ") + chosen + " cannot be opened");
    }
    return lcm;
}

class LcmFeed
{
  public:
    /* url: as join_lcm. */
    explicit LcmFeed(const std::string &url) : lcm_(join_lcm(url))
    {
    }

    template <class Message> void on(const std::string &channel, std::function<void(const Message &)> handler)
    {
        receivers_.push_back([handler](const lcm_recv_buf_t &buffer) {
            Message message;
            if (buffer.data_size > static_cast<uint32_t>(std::numeric_limits<int>::max()) ||
                message.decode(buffer.data, 0, static_cast<int>(buffer.data_size)) < 0) {
                throw std::runtime_error("truncated, or of another type");
            }
            handler(message);
        });
        subscribe(channel);
    }

    /* Waits for one message and handles it. False when the time is over or a signal came; throws when LCM
     * fails. */
    bool wait(int timeout_ms)
    {
        errno = 0;
        const int handled = lcm_handle_timeout(lcm_.get(), timeout_ms);
        if (handled < 0 && errno != EINTR) {
            throw std::runtime_error("LCM stopped receiving");
        }
        return handled > 0;
    }

    uint64_t malformed() const
    {
        return malformed_;
    }

  private:
    /* Enough for a burst that fills the kernel's buffer; more would only hide that we are too slow. */
    static constexpr int queue_messages = 1000;

    struct Subscription {
        LcmFeed *feed;
        size_t receiver;
    };

    void subscribe(const std::string &channel)
    {
        subscriptions_.push_back(std::make_unique<Subscription>(Subscription{this, receivers_.size() - 1}));
        lcm_subscription_t *subscription =
            lcm_subscribe(lcm_.get(), channel.c_str(), receive, subscriptions_.back().get());
        if (subscription == nullptr) {
            throw std::runtime_error("cannot subscribe to " + channel);
        }
        lcm_subscription_set_queue_capacity(subscription, queue_messages);
    }

    static void receive(const lcm_recv_buf_t *buffer, const char *, void *user) noexcept
    {
        const auto *subscription = static_cast<const Subscription *>(user);
        try {
            subscription->feed->receivers_[subscription->receiver](*buffer);
        } catch (const std::exception &) {
            subscription->feed->malformed_++;
        }
    }

    std::vector<std::function<void(const lcm_recv_buf_t &)>> receivers_;
    std::vector<std::unique_ptr<Subscription>> subscriptions_;
    uint64_t malformed_ = 0;
    Lcm lcm_;
};

} // namespace feed

#endif
