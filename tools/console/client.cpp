#include "console/client.h"

#include "console/messages.h"

namespace console
{

std::optional<std::string> Client::next(Board::Clock::time_point now)
{
    if (sent_ - drawn_ >= window) {
        return std::nullopt;
    }
    auto message = choose(now);
    if (message) {
        sent_++;
    }
    return message;
}

std::optional<std::string> Client::choose(Board::Clock::time_point now)
{
    if (life_ != board_.life()) {
        life_ = board_.life();
        return hello_message();
    }
    if (link_due_) {
        link_due_ = false;
        return link_message(board_.link(now), skipped_);
    }
    auto trail = next_trail();
    return trail ? trail : next_topic();
}

std::optional<std::string> Client::next_topic()
{
    for (size_t k = 0; k < topic_count; k++) {
        const size_t topic = (turn_ + k) % topic_count;
        const Pinned pinned = board_.newest(static_cast<Topic>(topic));
        if (pinned.text && pinned.number != seen_[topic]) {
            if (seen_[topic] != 0) {
                skipped_ += pinned.number - seen_[topic] - 1;
            }
            seen_[topic] = pinned.number;
            turn_ = topic + 1;
            return *pinned.text;
        }
    }
    return std::nullopt;
}

std::optional<std::string> Client::next_trail()
{
    const TrailPiece piece = board_.trail(trail_epoch_, trail_next_, trail_points_a_message);
    const bool anew = piece.epoch != trail_epoch_;
    if (piece.points.empty() && !anew) {
        return std::nullopt;
    }
    trail_epoch_ = piece.epoch;
    trail_next_ = piece.first + piece.points.size();
    return trail_message(piece);
}

void Client::link_due()
{
    link_due_ = true;
}

bool Client::heard(const std::string &text)
{
    const std::optional<uint64_t> count = drawn_count(text);
    if (!count || *count < drawn_ || *count > sent_) {
        return false;
    }
    drawn_ = *count;
    return true;
}

} // namespace console
