#include "operator/console/board.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace console
{

namespace
{

/* Of this computer; a clock that is set back must not bring times out of order. */
int64_t now_ms()
{
    using std::chrono::duration_cast;
    using std::chrono::milliseconds;
    static const int64_t offset_ms =
        duration_cast<milliseconds>(std::chrono::system_clock::now().time_since_epoch()).count() -
        duration_cast<milliseconds>(Board::Clock::now().time_since_epoch()).count();
    return offset_ms + duration_cast<milliseconds>(Board::Clock::now().time_since_epoch()).count();
}

} // namespace

void Board::on_change(std::function<void()> wake)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_ = std::move(wake);
}

void Board::wake() const
{
    std::function<void()> wake;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake = wake_;
    }
    if (wake) {
        wake();
    }
}

void Board::pin(Topic topic, std::string text, const std::string &brief)
{
    auto shared = std::make_shared<const std::string>(std::move(text));
    History::Text in_brief = brief.empty() ? nullptr : std::make_shared<const std::string>(brief);
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        Pinned &pinned = pinned_[static_cast<size_t>(topic)];
        pinned.text = shared;
        pinned.number++;
        history_.keep(topic, now_ms(), std::move(shared), std::move(in_brief));
    }
    wake();
}

Pinned Board::newest(Topic topic) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return pinned_[static_cast<size_t>(topic)];
}

void Board::keep_map(std::shared_ptr<const ale_map_t> map)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    map_ = std::move(map);
}

std::shared_ptr<const ale_map_t> Board::map() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return map_;
}

void Board::extend_trail(TrailPoint point)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.keep_point(now_ms(), point);
    if (!trail_.empty() && !point.first) {
        const TrailPoint &last = trail_.back();
        if (std::hypot(point.x - last.x, point.y - last.y) < trail_spacing_m_) {
            return;
        }
    }
    trail_.push_back(point);
    if (trail_.size() >= trail_capacity) {
        halve_trail();
    }
}

/* A robot that drives all day keeps its whole trail, at a coarser spacing. */
void Board::halve_trail()
{
    std::vector<TrailPoint> kept;
    bool jumped = false;
    for (size_t k = 0; k < trail_.size(); k++) {
        jumped = jumped || trail_[k].first;
        if (k % 2 == 0) {
            kept.push_back({trail_[k].x, trail_[k].y, jumped});
            jumped = false;
        }
    }
    trail_ = std::move(kept);
    trail_spacing_m_ *= 2;
    trail_epoch_++;
}

ale::ScanCloud Board::seen() const
{
    const std::lock_guard<std::mutex> lock(seeing_);
    return seen_.cloud();
}

void Board::clear()
{
    {
        const std::lock_guard<std::mutex> lock(seeing_);
        seen_ = feed::SeenSpace();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Pinned &pinned : pinned_) {
        pinned.text.reset();
    }
    map_.reset();
    life_++;
    trail_.clear();
    trail_epoch_++;
    trail_spacing_m_ = finest_spacing_m;
    history_.clear();
    arrivals_.clear();
    poses_ = 0;
    lost_poses_ = 0;
}

uint64_t Board::life() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return life_;
}

TrailPiece Board::trail(uint64_t epoch, size_t first, size_t limit) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    const size_t from = epoch == trail_epoch_ ? std::min(first, trail_.size()) : 0;
    const size_t count = std::min(limit, trail_.size() - from);
    const auto begin = trail_.begin() + static_cast<std::ptrdiff_t>(from);
    return {trail_epoch_, from, {begin, begin + static_cast<std::ptrdiff_t>(count)}};
}

void Board::note_pose(Clock::time_point arrival, uint64_t lost_before, int state)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = state;
    poses_++;
    lost_poses_ += lost_before;
    if (arrivals_.size() == rate_window) {
        arrivals_.erase(arrivals_.begin());
    }
    arrivals_.push_back(arrival);
}

void Board::note_malformed(uint64_t total)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    malformed_ = total;
}

LinkHealth Board::link(Clock::time_point now) const
{
    using std::chrono::duration;
    using std::chrono::duration_cast;
    using std::chrono::milliseconds;
    const std::lock_guard<std::mutex> lock(mutex_);
    LinkHealth health;
    health.poses = poses_;
    health.lost_poses = lost_poses_;
    health.malformed = malformed_;
    health.state = state_;
    if (arrivals_.empty()) {
        return health;
    }
    health.pose_age_ms = duration_cast<milliseconds>(now - arrivals_.back()).count();
    const double span_s = duration<double>(arrivals_.back() - arrivals_.front()).count();
    if (span_s > 0) {
        health.pose_rate_hz = static_cast<double>(arrivals_.size() - 1) / span_s;
    }
    return health;
}

History::Span Board::span() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return history_.span();
}

Past Board::look_back(int64_t at_ms) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return {history_.span(), history_.trail(at_ms), history_.at(at_ms)};
}

std::vector<History::Text> Board::sample(Topic topic, size_t most) const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return history_.sample(topic, most);
}

} // namespace console
