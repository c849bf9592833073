#include "operator/send/robot_link.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "common/feed/vouched.h"

namespace send
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr int look_ms = 20;

} // namespace

RobotLink::RobotLink(const std::string &url, const std::string &robot, const ale_secret_key_t &key,
                     const ale_keys_t &robots)
    : wanted_(robot), end_(robots, robot), feed_(url)
{
    end_.take_key(url, key);
    feed_.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &status) { take(status); });
    feed_.on_bytes("ALE_VOUCHED", [this](const uint8_t *bytes, size_t count) { take_vouched(bytes, count); });
}

bool RobotLink::answers(const ale::status_t &status) const
{
    return status.command_operator == end_.name() &&
           std::find(numbers_.begin(), numbers_.end(), status.command_counter) != numbers_.end();
}

void RobotLink::note_answer(const ale::status_t &status)
{
    const std::vector<std::string> heard = end_.heard();
    if (answers(status) && std::find(heard.begin(), heard.end(), status.robot) != heard.end()) {
        answers_[status.robot] = status;
    }
}

void RobotLink::take(const ale::status_t &status)
{
    if (is_vouched()) {
        if (wanted_.empty() || status.robot == wanted_) {
            unbelieved_ = status;
        }
        return;
    }
    if (end_.saw(status)) {
        status_ = status;
    }
    note_answer(status);
}

void RobotLink::take_vouched(const uint8_t *bytes, size_t count)
{
    const auto message = feed::vouched_by(end_.robots(), bytes, count);
    if (!message) {
        return;
    }
    if (end_.saw(*message)) {
        status_ = message->status;
    }
    note_answer(message->status);
}

bool RobotLink::wait(int timeout_ms, const std::function<bool()> &condition)
{
    const Clock::time_point end = Clock::now() + std::chrono::milliseconds(timeout_ms);
    while (!condition()) {
        if (Clock::now() >= end) {
            return false;
        }
        feed_.wait(look_ms);
    }
    return true;
}

void RobotLink::command(const ale_command_t &command, int64_t life_us)
{
    const std::vector<int64_t> numbers = end_.send(command, life_us);
    if (numbers.empty()) {
        throw std::runtime_error("no robot to command");
    }
    last_ = numbers.front();
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
}

bool RobotLink::was_misled() const
{
    return end_.was_misled(end_.made());
}

bool RobotLink::answered() const
{
    return status_ && answers(*status_);
}

std::vector<std::string> RobotLink::unanswered() const
{
    std::vector<std::string> names;
    for (const std::string &name : end_.heard()) {
        if (answers_.count(name) == 0) {
            names.push_back(name);
        }
    }
    return names;
}

bool RobotLink::drives_since() const
{
    return status_ && status_->command_operator == end_.name() && status_->command_counter > last_ &&
           status_->command_obeyed && status_->who_drives == end_.name();
}

} // namespace send
