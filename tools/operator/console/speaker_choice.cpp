#include "operator/console/speaker_choice.h"

#include <algorithm>
#include <iterator>

namespace console
{

namespace
{

/* Statuses come once a second, poses more often. */
constexpr std::chrono::milliseconds silence{1500};
constexpr std::chrono::seconds lately{3};
constexpr size_t most_speakers = 4;

/* What others put into a message is not all fit to be shown. */
template <size_t size> std::string printable(const uint8_t (&text)[size])
{
    const auto *end = std::find(std::begin(text), std::end(text), 0);
    std::string words(std::begin(text), end);
    std::replace_if(
        words.begin(), words.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return words;
}

} // namespace

bool SpeakerChoice::shows(uint64_t sender, Clock::time_point now)
{
    if (sender == 0) {
        return true;
    }
    if (chosen_ == 0 || now - heard_at_ > silence) {
        chosen_ = sender;
        asked_for_ = false;
    }
    if (sender == chosen_) {
        heard_at_ = now;
    }
    return sender == chosen_;
}

bool SpeakerChoice::choose(uint64_t sender, Clock::time_point now)
{
    const bool other = chosen_ != 0 && chosen_ != sender;
    if (other && asked_for_ && now - heard_at_ <= silence) {
        return false;
    }
    asked_for_ = true;
    chosen_ = sender;
    heard_at_ = now;
    return other;
}

void SpeakerChoice::heard(const ale::speaker_t &speaker, Clock::time_point now)
{
    speakers_[speaker.boot] = {printable(speaker.robot) + " on " + printable(speaker.host) + ", process " +
                                   std::to_string(speaker.process),
                               now};
    while (speakers_.size() > most_speakers) {
        speakers_.erase(
            std::min_element(speakers_.begin(), speakers_.end(), [](const auto &a, const auto &b) {
                return a.second.heard_at < b.second.heard_at;
            }));
    }
}

std::optional<std::string> SpeakerChoice::warning(std::optional<int64_t> shown_boot,
                                                  Clock::time_point now) const
{
    for (const auto &[boot, speaker] : speakers_) {
        if (shown_boot && boot != *shown_boot && now - speaker.heard_at < lately) {
            return "Another robot speaks on the same channels, and is not shown: " + speaker.words +
                   ". End one of the two, or give it channels of its own ([lcm] prefix).";
        }
    }
    return std::nullopt;
}

} // namespace console
