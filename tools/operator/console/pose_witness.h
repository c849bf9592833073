/* Poses that were heard against those that the robot vouches for: anybody on the bus may publish a pose, and
 * one with a high number keeps the true ones from being shown. Pure; one thread. */
#ifndef CONSOLE_POSE_WITNESS_H
#define CONSOLE_POSE_WITNESS_H

#include <chrono>
#include <cstdint>
#include <deque>

#include "ale/vouched_t.hpp"

namespace console
{

class PoseWitness
{
  public:
    using Clock = std::chrono::steady_clock;

    /* An ALE_POSE came in: its scan, and the digest of its bytes as vouched_t has it. */
    void heard(int32_t scan, int64_t digest, Clock::time_point now);

    /* The robot vouches for its newest poses. How many of those that were heard since are not its own;
     * of a flood that would hide them, those that there was no room for. */
    uint64_t compare(const ale::vouched_t &vouched, Clock::time_point now);

    /* Some were found within the last ten seconds. */
    bool is_alarmed(Clock::time_point now) const;

    /* While alarmed: a number that the robot cannot have reached yet. Such a pose would keep its own from
     * being shown. */
    bool is_beyond(int32_t scan, Clock::time_point now) const;

    uint64_t forged() const
    {
        return forged_;
    }

  private:
    struct Heard {
        int32_t scan;
        int64_t digest;
        Clock::time_point when;
    };
    enum class Verdict { true_one, forged, open };
    double expected(Clock::time_point now) const;
    void note_reached(const ale::vouched_t &vouched, Clock::time_point now);
    static Verdict judge(const Heard &pose, const ale::vouched_t &vouched, Clock::time_point now);

    std::deque<Heard> heard_; /* not yet judged */
    uint64_t forged_ = 0;
    uint64_t crowded_out_ = 0; /* unjudged, by more poses than a robot sends: any may have been forged */
    Clock::time_point alarm_{};
    double reached_ = 0; /* the robot's newest scan, by words that were held up least */
    double rate_hz_ = 0; /* 0: not known yet */
    Clock::time_point reached_at_{};
};

} // namespace console

#endif
