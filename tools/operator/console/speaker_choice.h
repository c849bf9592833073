/* Which robot is shown, where several speak on the same channels: messages of two would wipe each other's
 * trail. A robot is known by the socket that it sends from, and says who it is by ALE_SPEAKER. LCM thread
 * only. */
#ifndef CONSOLE_SPEAKER_CHOICE_H
#define CONSOLE_SPEAKER_CHOICE_H

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "ale/speaker_t.hpp"

namespace console
{

class SpeakerChoice
{
  public:
    using Clock = std::chrono::steady_clock;

    /* Whether a message of this sender (ale_wire_sender) is shown: of the first one that was heard, for as
     * long as it speaks; of any where the transport does not tell them apart (0). */
    bool shows(uint64_t sender, Clock::time_point now);

    /* It is this one that was asked for, unless one that was is shown already. True when it was another one.
     */
    bool choose(uint64_t sender, Clock::time_point now);

    /* Who says so. Of many starts the newest few are remembered. */
    void heard(const ale::speaker_t &speaker, Clock::time_point now);

    /* A line for people while another one speaks than the start that is shown. */
    std::optional<std::string> warning(std::optional<int64_t> shown_boot, Clock::time_point now) const;

  private:
    struct Speaker {
        std::string words;
        Clock::time_point heard_at;
    };

    uint64_t chosen_ = 0; /* none yet */
    bool asked_for_ = false;
    Clock::time_point heard_at_;
    std::map<int64_t, Speaker> speakers_; /* by boot nonce */
};

} // namespace console

#endif
