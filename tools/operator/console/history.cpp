#include "operator/console/history.h"

#include <algorithm>
#include <utility>

namespace console
{

namespace
{

constexpr int64_t trail_ms = int64_t{2} * 60 * 1000;
constexpr int64_t scan_ms = 200; /* what belongs to the newest pose has come by then */

} // namespace

const std::deque<History::Kept> &History::of(Topic topic) const
{
    return kept_[static_cast<size_t>(topic)];
}

void History::keep(Topic topic, int64_t at_ms, Text text, Text brief)
{
    std::deque<Kept> &kept = kept_[static_cast<size_t>(topic)];
    Kept entry = {at_ms, std::move(text), std::move(brief)};
    bytes_ += entry.bytes();
    const bool is_large = topic == Topic::map || topic == Topic::graph;
    const bool replaces =
        is_large && kept.size() > 1 && kept.back().at_ms - kept[kept.size() - 2].at_ms < map_period_ms;
    if (replaces) {
        bytes_ -= kept.back().bytes();
        kept.back() = std::move(entry);
    } else {
        kept.push_back(std::move(entry));
    }
    drop_old(at_ms);
}

void History::keep_point(int64_t at_ms, TrailPoint point)
{
    points_.push_back({at_ms, point});
    while (points_.front().at_ms < at_ms - longest_ms) {
        points_.pop_front();
    }
}

void History::clear()
{
    *this = History();
}

void History::drop_first(std::deque<Kept> &kept)
{
    bytes_ -= kept.front().bytes();
    kept.pop_front();
}

/* Of each topic one stays that is older: what was to be seen at the beginning. */
void History::drop_old(int64_t now_ms)
{
    for (std::deque<Kept> &kept : kept_) {
        while (kept.size() > 1 && kept[1].at_ms <= now_ms - longest_ms) {
            drop_first(kept);
        }
    }
    while (bytes_ > most_bytes) {
        const auto oldest = std::min_element(kept_.begin(), kept_.end(), [](const auto &a, const auto &b) {
            return (a.size() > 1 ? a[1].at_ms : INT64_MAX) < (b.size() > 1 ? b[1].at_ms : INT64_MAX);
        });
        if (oldest->size() <= 1) {
            return;
        }
        drop_first(*oldest);
    }
}

History::Span History::span() const
{
    const std::deque<Kept> &poses = of(Topic::pose);
    return poses.empty() ? Span{} : Span{poses.front().at_ms, poses.back().at_ms};
}

const History::Text *History::newest(const std::deque<Kept> &kept, int64_t at_ms)
{
    const auto after = std::upper_bound(kept.begin(), kept.end(), at_ms,
                                        [](int64_t time, const Kept &entry) { return time < entry.at_ms; });
    return after == kept.begin() ? nullptr : &std::prev(after)->text;
}

/* The last moment before the pose that follows. */
int64_t History::end_of_scan(int64_t at_ms) const
{
    const std::deque<Kept> &poses = of(Topic::pose);
    const auto next = std::upper_bound(poses.begin(), poses.end(), at_ms,
                                       [](int64_t time, const Kept &entry) { return time < entry.at_ms; });
    return next == poses.end() ? at_ms + scan_ms : next->at_ms - 1;
}

std::vector<History::Text> History::at(int64_t at_ms) const
{
    const int64_t end_ms = end_of_scan(at_ms);
    std::vector<Text> texts;
    for (const std::deque<Kept> &kept : kept_) {
        if (const Text *text = newest(kept, &kept == &of(Topic::pose) ? at_ms : end_ms)) {
            texts.push_back(*text);
        }
    }
    return texts;
}

std::vector<TrailPoint> History::trail(int64_t at_ms) const
{
    std::vector<TrailPoint> way;
    for (const Point &point : points_) {
        if (point.at_ms > at_ms - trail_ms && point.at_ms <= at_ms) {
            way.push_back(point.point);
        }
    }
    return way;
}

std::vector<History::Text> History::sample(Topic topic, size_t most) const
{
    const std::deque<Kept> &kept = of(topic);
    std::vector<Text> texts;
    const size_t count = std::min(most, kept.size());
    for (size_t k = 0; k < count; k++) {
        const Kept &entry = kept[k * kept.size() / count];
        texts.push_back(entry.brief ? entry.brief : entry.text);
    }
    return texts;
}

} // namespace console
