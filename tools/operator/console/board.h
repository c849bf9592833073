/* The board between the LCM thread, which pins the newest of everything to it, and the web thread, which
 * reads. What is replaced before a slow client has read it is gone for that client: newest wins.
 *
 * The trail is the exception: every client gets all of it, from wherever he stands. What was to be seen in
 * the last ten minutes is kept, too (history.h). */
#ifndef CONSOLE_BOARD_H
#define CONSOLE_BOARD_H

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/feed/seen_space.h"
#include "operator/console/history.h"
#include "operator/console/topic.h"

extern "C" {
#include "track/pipeline.h"
}

namespace console
{

/* One message as pinned: its text, and how many of its topic there were so far, this one included. */
struct Pinned {
    std::shared_ptr<const std::string> text;
    uint64_t number = 0;
};

/* A stretch of the trail from index first on. The epoch changes when indices do. */
struct TrailPiece {
    uint64_t epoch;
    size_t first;
    std::vector<TrailPoint> points;
};

/* A longer step on the map is no way: the trail begins anew. */
constexpr float trail_jump_m = 0.5F;

/* A moment of the past: the span of what is kept, the way up to there, the newest of each topic. */
struct Past {
    History::Span span;
    std::vector<TrailPoint> way;
    std::vector<History::Text> texts;
};

/* What a console can say about its own link to the robot. */
struct LinkHealth {
    int64_t pose_age_ms = -1; /* since the last pose came in; -1: none yet */
    double pose_rate_hz = 0;
    uint64_t poses = 0;
    uint64_t lost_poses = 0; /* by gaps in the numbers of the scans */
    uint64_t malformed = 0;
    int state = 0; /* of the last pose, as in pose_t */
};

class Board
{
  public:
    using Clock = std::chrono::steady_clock;

    /* Called on the LCM thread after each change; it must only wake somebody. */
    void on_change(std::function<void()> wake);

    /* brief: what charts want of it (sample), where that is not all of it. */
    void pin(Topic topic, std::string text, const std::string &brief = "");
    Pinned newest(Topic topic) const;

    /* The map that is pinned, for who writes it to a file; nullptr: none yet. */
    void keep_map(std::shared_ptr<const ale_map_t> map);
    std::shared_ptr<const ale_map_t> map() const;

    /* What scans saw, of scan, pose, tracking and graph as they come. Who asks for it has a copy, and the LCM
     * thread waits while it is made: some milliseconds. */
    template <class Message> void see(const Message &message)
    {
        const std::lock_guard<std::mutex> lock(seeing_);
        seen_.take(message);
    }
    ale::ScanCloud seen() const;

    void extend_trail(TrailPoint point);
    /* The robot started anew: its trail and what was pinned belong to a former life. */
    void clear();
    uint64_t life() const;
    /* At most limit points from index first of that epoch; from the start if the epoch is another. */
    TrailPiece trail(uint64_t epoch, size_t first, size_t limit) const;

    void note_pose(Clock::time_point arrival, uint64_t lost_before, int state);
    void note_malformed(uint64_t total);
    LinkHealth link(Clock::time_point now) const;

    /* What the board showed then, milliseconds since 1970 of this computer. */
    Past look_back(int64_t at_ms) const;
    History::Span span() const;
    /* So many of a topic over the whole time, in brief, for charts. */
    std::vector<History::Text> sample(Topic topic, size_t most) const;

  private:
    static constexpr size_t trail_capacity = 20000;
    static constexpr float finest_spacing_m = 0.02F;
    static constexpr size_t rate_window = 20;

    void wake() const;
    void halve_trail();

    mutable std::mutex mutex_;
    std::function<void()> wake_;
    std::array<Pinned, topic_count> pinned_;
    std::shared_ptr<const ale_map_t> map_;
    uint64_t life_ = 1;
    std::vector<TrailPoint> trail_;
    uint64_t trail_epoch_ = 1;
    float trail_spacing_m_ = finest_spacing_m;
    std::vector<Clock::time_point> arrivals_; /* the last few poses, oldest first */
    uint64_t poses_ = 0;
    uint64_t lost_poses_ = 0;
    uint64_t malformed_ = 0;
    int state_ = 0;
    History history_;
    mutable std::mutex seeing_;
    feed::SeenSpace seen_;
};

} // namespace console

#endif
