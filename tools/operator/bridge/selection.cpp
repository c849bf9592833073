#include "operator/bridge/selection.h"

#include <cmath>

#include "common/command_line/words.h"
#include "operator/bridge/frame.h"

namespace bridge
{

namespace
{

constexpr double least_hz = 0.001;
constexpr double most_hz = 1000;
constexpr double us_per_s = 1e6;

int64_t period_of(const std::string &word, const std::string &rate)
{
    return std::llround(us_per_s / cli::number_of(word + ": rate", rate, least_hz, most_hz));
}

} // namespace

Selection::Selection(const std::vector<std::string> &words)
{
    for (const std::string &word : words) {
        const size_t colon = word.find(':');
        const std::string channel = word.substr(0, colon);
        if (channel.empty() || channel.size() > most_channel) {
            throw cli::WrongUse("\"" + word + "\" names no channel");
        }
        channels_[channel].period_us =
            colon == std::string::npos ? 0 : period_of(word, word.substr(colon + 1));
    }
}

bool Selection::take(const std::string &channel, int64_t now_us)
{
    const auto found = channels_.find(channel);
    if (found == channels_.end()) {
        return false;
    }
    Pace &pace = found->second;
    /* A quarter of a period early is on time: messages that come evenly do not come exactly so. */
    if (now_us < pace.due_us - pace.period_us / 4) {
        return false;
    }
    const bool paused = now_us - pace.due_us > pace.period_us;
    pace.due_us = (paused ? now_us : pace.due_us) + pace.period_us;
    return true;
}

std::vector<std::string> Selection::names() const
{
    std::vector<std::string> all;
    for (const auto &[name, pace] : channels_) {
        all.push_back(name);
    }
    return all;
}

} // namespace bridge
