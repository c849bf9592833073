/* The way out: bytes wait here until the line takes them, at most so many a second. */
#ifndef ALE_LAB_SIM_LINE_H
#define ALE_LAB_SIM_LINE_H

#include <algorithm>
#include <cstdint>
#include <string>

#include "lab/sim/line/port.h"

namespace sim
{

class Line
{
  public:
    /* bytes_per_second 0: as fast as the pseudo terminal takes them. Times are simulated. */
    explicit Line(int64_t bytes_per_second) : rate_(bytes_per_second)
    {
    }

    void send(const std::string &bytes)
    {
        queue_ += bytes;
    }
    bool busy() const
    {
        return !queue_.empty();
    }
    /* No room for another frame: at a limited rate the device drops it as soon as one waits; otherwise only
     * a client that has not read for long costs frames. */
    bool full() const
    {
        return queue_.size() > (rate_ > 0 ? 0 : patience_bytes);
    }
    void drop()
    {
        queue_.clear();
    }

    void pump(Port &port, int64_t now_us, int64_t host_us)
    {
        if (!busy()) {
            paid_us_ = now_us;
            return;
        }
        const std::string ready = queue_.substr(0, affordable(now_us));
        if (ready.empty()) {
            return;
        }
        const size_t sent = port.write(ready, host_us);
        queue_.erase(0, sent);
        paid_us_ = rate_ > 0 && busy() ? paid_us_ + static_cast<int64_t>(sent) * 1000000 / rate_ : now_us;
    }

    /* When it makes sense to pump again. */
    int64_t next_us(int64_t now_us) const
    {
        return busy() ? now_us + retry_us : INT64_MAX;
    }

  private:
    static constexpr int64_t retry_us = 1000;
    static constexpr size_t patience_bytes = 65536;

    size_t affordable(int64_t now_us) const
    {
        return rate_ > 0 ? static_cast<size_t>(std::max<int64_t>(0, (now_us - paid_us_) * rate_ / 1000000))
                         : queue_.size();
    }

    int64_t rate_;
    int64_t paid_us_ = 0; /* the bytes sent so far fill the line up to this time */
    std::string queue_;
};

} // namespace sim

#endif
