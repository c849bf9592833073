#include "operator/console/antechamber.h"

#include <algorithm>

namespace console
{

std::optional<Antechamber::Id> Antechamber::enter(Id id, const std::string &peer, Clock::time_point now)
{
    waiting_[id] = {peer, now};
    if (waiting_.size() <= most) {
        return std::nullopt;
    }
    std::unordered_map<std::string, size_t> of_peer;
    for (const auto &entry : waiting_) {
        of_peer[entry.second.peer]++;
    }
    const auto goes_before = [&](const auto &one, const auto &other) {
        const size_t ones = of_peer[one.second.peer];
        const size_t others = of_peer[other.second.peer];
        return ones != others ? ones > others : one.second.since < other.second.since;
    };
    const Id who = std::min_element(waiting_.begin(), waiting_.end(), goes_before)->first;
    waiting_.erase(who);
    return who;
}

void Antechamber::renew(Id id, Clock::time_point now)
{
    const auto found = waiting_.find(id);
    if (found != waiting_.end()) {
        found->second.since = now;
    }
}

void Antechamber::leave(Id id)
{
    waiting_.erase(id);
}

std::vector<Antechamber::Id> Antechamber::overdue(Clock::time_point now) const
{
    std::vector<Id> all;
    for (const auto &[id, one] : waiting_) {
        if (now - one.since >= patience) {
            all.push_back(id);
        }
    }
    return all;
}

} // namespace console
