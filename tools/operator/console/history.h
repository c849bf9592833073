/* What was pinned to the board lately, for looking back: ten minutes of it, and never more than so many
 * bytes.
 *
 *   history.keep(Topic::pose, at_ms, text);          as it comes; times never go back
 *   for (const auto &text : history.at(at_ms)) ...   what was to be seen then
 *
 * Texts are shared with the board. Not thread-safe: the board's mutex guards it. */
#ifndef CONSOLE_HISTORY_H
#define CONSOLE_HISTORY_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "operator/console/topic.h"

namespace console
{

class History
{
  public:
    using Text = std::shared_ptr<const std::string>;

    static constexpr int64_t longest_ms = int64_t{10} * 60 * 1000;
    static constexpr size_t most_bytes = size_t{64} * 1024 * 1024;
    /* Maps and graphs are large; older ones are kept this far apart. */
    static constexpr int64_t map_period_ms = 5000;

    struct Span {
        int64_t from_ms = 0;
        int64_t to_ms = 0; /* the same: nothing is kept */
    };

    /* brief: what charts want of it, where that is not all of it. */
    void keep(Topic topic, int64_t at_ms, Text text, Text brief = {});
    void keep_point(int64_t at_ms, TrailPoint point);
    void clear();

    Span span() const;

    /* The newest of each topic at that time, in the order of topics, with what belongs to that pose: its
     * features and scan came after it. */
    std::vector<Text> at(int64_t at_ms) const;

    /* The way of the two minutes before. */
    std::vector<TrailPoint> trail(int64_t at_ms) const;

    /* At most so many of a topic, in equal steps of their number, in brief. */
    std::vector<Text> sample(Topic topic, size_t most) const;

  private:
    struct Kept {
        int64_t at_ms;
        Text text;
        Text brief;
        size_t bytes() const
        {
            return text->size() + (brief ? brief->size() : 0);
        }
    };
    struct Point {
        int64_t at_ms;
        TrailPoint point;
    };

    static const Text *newest(const std::deque<Kept> &kept, int64_t at_ms);
    const std::deque<Kept> &of(Topic topic) const;
    int64_t end_of_scan(int64_t at_ms) const;
    void drop_old(int64_t now_ms);
    void drop_first(std::deque<Kept> &kept);

    std::array<std::deque<Kept>, topic_count> kept_;
    std::deque<Point> points_;
    size_t bytes_ = 0;
};

} // namespace console

#endif
