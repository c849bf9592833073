/* In which order messages arrived: what is older than the newest of its channel is late, and of no use for
 * channels that tell a state. Pure. Sequences are those of one session, which nobody else can move. */
#ifndef BRIDGE_ARRIVALS_H
#define BRIDGE_ARRIVALS_H

#include <cstdint>
#include <map>
#include <string>

namespace bridge
{

class Arrivals
{
  public:
    /* False for a late message. A command is never late here: the robot knows which it has heard, and one
     * that was overtaken may be a stop. */
    bool take(const std::string &channel, uint64_t sequence);

    /* Messages that did not come, or not in time, as far as later ones show. */
    uint64_t lost() const
    {
        return newest_ > received_ ? newest_ - received_ : 0;
    }
    uint64_t late() const
    {
        return late_;
    }

  private:
    uint64_t newest_ = 0;
    std::map<std::string, uint64_t> newest_of_;
    uint64_t received_ = 0;
    uint64_t late_ = 0;
};

} // namespace bridge

#endif
