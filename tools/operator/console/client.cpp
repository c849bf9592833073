#include "operator/console/client.h"

#include <algorithm>
#include <iterator>
#include <utility>

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
    if (life_ != board_.life() && !recording_) {
        life_ = board_.life();
        looks_back_ = false;
        past_.clear();
        return greet();
    }
    if (!answers_.empty()) {
        std::string answer = std::move(answers_.front());
        answers_.pop_front();
        return answer;
    }
    if (auto report = next_report(now)) {
        return report;
    }
    if (!past_.empty()) {
        std::string message = std::move(past_.front());
        past_.pop_front();
        return message;
    }
    if (looks_back_) {
        return std::nullopt;
    }
    auto trail = next_trail();
    return trail ? trail : next_topic();
}

std::string Client::greet()
{
    told_ = company_.told();
    return hello_message(operator_name_, company_.robot, told_);
}

/* Of the link, and behind it how the robots are, if that has changed. */
std::optional<std::string> Client::next_report(Board::Clock::time_point now)
{
    if (link_due_) {
        link_due_ = false;
        company_due_ = true;
        return link_message(board_.link(now), skipped_, span(), recordings_.state());
    }
    if (!company_due_) {
        return std::nullopt;
    }
    company_due_ = false;
    const std::vector<RobotTold> before = std::exchange(told_, company_.told());
    const bool same = std::equal(told_.begin(), told_.end(), before.begin(), before.end(),
                                 [](const auto &a, const auto &b) { return a.state == b.state; });
    return same ? std::nullopt : std::optional(robots_message(told_));
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
    const std::optional<PageMessage> message = page_message(text);
    if (!message) {
        return false;
    }
    switch (message->kind) {
    case PageMessage::Kind::got:
        return got(message->drawn);
    case PageMessage::Kind::command:
        return command(message->words);
    case PageMessage::Kind::stop_all:
        return stop_all();
    case PageMessage::Kind::look:
        return look(message->at_ms);
    case PageMessage::Kind::series:
        return tell_series();
    case PageMessage::Kind::shelf:
    case PageMessage::Kind::record:
    case PageMessage::Kind::open:
        return ask(*message);
    }
    return false;
}

/* Of the recording that is shown, or of the robot. */
Past Client::look_back(int64_t at_ms) const
{
    return recording_ ? recording_->look_back(at_ms) : board_.look_back(at_ms);
}

History::Span Client::span() const
{
    return recording_ ? recording_->span() : board_.span();
}

std::vector<History::Text> Client::sample(Topic topic) const
{
    return recording_ ? recording_->sample(topic, series_points) : board_.sample(topic, series_points);
}

void Client::show(std::shared_ptr<const OpenRecording> recording, const std::string &name)
{
    answered();
    if (name != wanted_name_) {
        return;
    }
    recording_ = std::move(recording);
    recording_name_ = name;
    look(recording_->span().from_ms);
}

/* Where he looks next takes the place of what was still to be sent of where he looked. Now again: all anew.
 */
bool Client::look(std::optional<int64_t> at_ms)
{
    looks_back_ = at_ms.has_value();
    if (at_ms) {
        const Past past = look_back(*at_ms);
        past_ = {past_message(at_ms, past.span, recording_name_, recording_ ? recording_->damage() : ""),
                 trail_message({0, 0, past.way})};
        std::transform(past.texts.begin(), past.texts.end(), std::back_inserter(past_),
                       [](const History::Text &text) { return *text; });
    } else {
        recording_.reset();
        recording_name_.clear();
        wanted_name_.clear();
        past_ = {past_message(std::nullopt, board_.span())};
        seen_.fill(0);
        trail_epoch_ = 0;
    }
    return true;
}

bool Client::tell_series()
{
    if (answers_.size() >= most_answers) {
        return false;
    }
    answers_.push_back(series_message({sample(Topic::pose), sample(Topic::tracking), sample(Topic::features),
                                       sample(Topic::scan), sample(Topic::odometry), sample(Topic::status)}));
    return true;
}

bool Client::ask(const PageMessage &message)
{
    if (answers_.size() + asked_ >= most_answers || !recordings_.ask(message)) {
        return false;
    }
    asked_++;
    if (message.kind == PageMessage::Kind::open) {
        wanted_name_ = message.name;
    }
    return true;
}

void Client::answered()
{
    asked_ -= asked_ > 0 ? 1 : 0;
}

void Client::answer(std::string message)
{
    answered();
    answers_.push_back(std::move(message));
}

bool Client::got(uint64_t count)
{
    if (count < drawn_ || count > sent_) {
        return false;
    }
    drawn_ = count;
    return true;
}

bool Client::command(const std::vector<std::string> &words)
{
    if (answers_.size() >= most_answers) {
        return false;
    }
    answers_.push_back(sent_message(words[0], command_(words)));
    return true;
}

bool Client::stop_all()
{
    if (answers_.size() >= most_answers) {
        return false;
    }
    answers_.push_back(sent_message("stop", company_.stop_all()));
    return true;
}

} // namespace console
