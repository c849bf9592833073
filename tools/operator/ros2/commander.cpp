#include "operator/ros2/commander.h"

#include <algorithm>
#include <stdexcept>

#include "common/feed/vouched.h"

extern "C" {
#include "command/message.h"
#include "command/verb.h"
}

namespace ros2
{

namespace
{

/* A set point that was held back on its way is worse than none. */
constexpr int64_t drive_life_us = 500000;
constexpr int64_t life_us = 5000000;

} // namespace

Commander::Commander(const Credentials &credentials)
    : end_(feed::believed(credentials.robots_file, credentials.key_file), credentials.robot)
{
    if (credentials.key_file.empty()) {
        return;
    }
    ale_secret_key_t key;
    char error[ALE_KEYS_ERROR];
    if (ale_secret_key_load(credentials.key_file.c_str(), &key, error) < 0) {
        throw std::runtime_error(error);
    }
    end_.take_key(credentials.lcm_url, key);
}

void Commander::note_answer(const ale::status_t &status)
{
    if (status.command_operator == end_.name() && status.command_counter == last_ && last_ != answered_) {
        answered_ = last_;
        answer_ = Answer{status.command_obeyed != 0, status.command_result};
    }
}

bool Commander::saw(const ale::status_t &status)
{
    if (believes() || !end_.saw(status)) {
        return false;
    }
    note_answer(status);
    return true;
}

std::optional<ale::status_t> Commander::saw_vouched(const uint8_t *bytes, size_t count)
{
    const auto message = feed::vouched_by(end_.robots(), bytes, count);
    if (!message || !end_.saw(*message)) {
        return std::nullopt;
    }
    note_answer(message->status);
    return message->status;
}

/* Why it cannot be known who is spoken to; empty: it is known. */
std::string Commander::doubt() const
{
    if (end_.robot().empty()) {
        return believes() ? "no robot is heard that vouches for itself with a key that is known"
                          : "no robot has been heard yet";
    }
    const std::string rival = end_.rival();
    return rival.empty() ? ""
                         : "two robots are heard, " + end_.robot() + " and " + rival +
                               ": choose one (ale-ros2 --robot NAME)";
}

std::string Commander::send(const std::vector<std::string> &words)
{
    if (!has_key()) {
        return "this bridge has no key: it only watches (ale-ros2 --keys FILE)";
    }
    std::vector<const char *> texts(words.size());
    std::transform(words.begin(), words.end(), texts.begin(), [](const auto &word) { return word.c_str(); });
    ale_command_t command;
    char error[ALE_VERB_ERROR];
    if (ale_command_from_words(texts.data(), static_cast<uint32_t>(texts.size()), &command) < 0) {
        return "too many words, or one that is too long";
    }
    const int verb = ale_verb_of(&command, error);
    if (verb < 0) {
        return error;
    }
    const std::string in_doubt = doubt();
    if (!in_doubt.empty()) {
        return in_doubt;
    }
    const std::vector<int64_t> numbers = end_.send(command, verb == ALE_VERB_DRIVE ? drive_life_us : life_us);
    if (numbers.empty()) {
        return "no robot has been heard yet";
    }
    last_ = numbers.front();
    return "";
}

std::optional<Answer> Commander::new_answer()
{
    std::optional<Answer> answer;
    answer.swap(answer_);
    return answer;
}

} // namespace ros2
