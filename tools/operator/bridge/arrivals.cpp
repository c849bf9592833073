#include "operator/bridge/arrivals.h"

#include <algorithm>

namespace bridge
{

bool Arrivals::take(const std::string &channel, uint64_t sequence)
{
    newest_ = std::max(newest_, sequence);
    uint64_t &newest = newest_of_[channel];
    if (sequence < newest && channel != "ALE_COMMAND") {
        late_++;
        return false;
    }
    newest = std::max(newest, sequence);
    received_++;
    return true;
}

} // namespace bridge
