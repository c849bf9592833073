/* In which order messages arrived: what is older than the newest of its channel is late, and of no use for
 * channels that tell a state. Pure. */
#ifndef BRIDGE_ARRIVALS_H
#define BRIDGE_ARRIVALS_H

#include <cstdint>
#include <map>
#include <string>

#include "operator/bridge/frame.h"

namespace bridge
{

class Arrivals
{
  public:
    /* False for a repeated or late message. A session that is new starts anew. */
    bool take(const Frame &frame);

    /* Messages that did not come, or not in time, as far as later ones show. */
    uint64_t lost() const
    {
        return expected_ - received_;
    }
    uint64_t late() const
    {
        return late_;
    }

  private:
    void start_session(const Frame &frame);

    bool any_ = false;
    uint32_t session_ = 0;
    uint32_t newest_ = 0;
    std::map<std::string, uint32_t> newest_of_;
    uint64_t expected_ = 0;
    uint64_t received_ = 0;
    uint64_t late_ = 0;
};

} // namespace bridge

#endif
