#include "operator/console/commander.h"

#include <algorithm>
#include <stdexcept>

#include "common/feed/vouched.h"

namespace console
{

namespace
{

constexpr std::chrono::seconds driving_lasts{2};
constexpr std::chrono::seconds stop_lasts{2};

/* A set point that was held back on its way is worse than none; anything else may take its time. */
constexpr int64_t drive_life_us = 500000;
constexpr int64_t life_us = 5000000;

Sent refused(const char *why)
{
    return {0, why};
}

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

bool Commander::saw(const ale::status_t &status)
{
    const std::lock_guard lock(mutex_);
    if (!believes()) {
        return end_.saw(status);
    }
    unbelieved_ = status.robot;
    return end_.robot().empty();
}

std::optional<ale::vouched_t> Commander::saw_vouched(const uint8_t *bytes, size_t count)
{
    const std::lock_guard lock(mutex_);
    auto message = feed::vouched_by(end_.robots(), bytes, count);
    if (message && !end_.saw(*message)) {
        message.reset();
    }
    return message;
}

void Commander::keep_stopped()
{
    const std::lock_guard lock(mutex_);
    if (stop_.stop && Clock::now() - stopped_at_ < stop_lasts && end_.was_misled(stop_)) {
        sign_and_send({"stop"});
    }
}

/* Why it cannot be known who is spoken to; empty: it is known. */
std::string Commander::doubt() const
{
    const std::string robot = end_.robot();
    const std::string rival = end_.rival();
    if (robot.empty()) {
        return unbelieved_.empty()
                   ? "no robot has been heard yet"
                   : unbelieved_ + " is heard, but no robot whose key is known vouches for it";
    }
    if (rival.empty()) {
        return "";
    }
    return rival == robot ? "two robots call themselves " + rival + ": they obey STOP alone"
                          : "two robots are heard, " + robot + " and " + rival +
                                ": choose one (ale-console --robot NAME); STOP goes to all";
}

std::vector<std::string> Commander::warnings()
{
    const std::lock_guard lock(mutex_);
    std::vector<std::string> lines;
    const std::string in_doubt = doubt();
    if (!in_doubt.empty()) {
        lines.push_back("Not sure who is heard: " + in_doubt + ".");
    }
    if (end_.has_key() && !believes()) {
        lines.emplace_back("Nobody vouches for what is shown: no robot's key is known (ale-keys --know).");
    }
    return lines;
}

bool Commander::may_drive(uint64_t page, Clock::time_point now)
{
    if (page != driving_page_ && now - drove_at_ < driving_lasts) {
        return false;
    }
    driving_page_ = page;
    drove_at_ = now;
    return true;
}

namespace
{

/* Printable ASCII, as the robot takes it. With anything else a word could look like another one, or like
 * none, to those who read it: a NUL ends it for some. */
bool is_plain(const std::string &word)
{
    return std::all_of(word.begin(), word.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

} // namespace

Sent Commander::send(uint64_t page, const std::vector<std::string> &words)
{
    const std::lock_guard lock(mutex_);
    if (!end_.has_key()) {
        return refused("this console has no key: it only watches (ale-console --keys FILE)");
    }
    if (words.empty()) {
        return refused("a command without a word");
    }
    if (!std::all_of(words.begin(), words.end(), is_plain)) {
        return refused("a word with a character that no command has");
    }
    if (words[0] == "drive" && !may_drive(page, Clock::now())) {
        return refused("somebody drives from another page");
    }
    const Sent sent = sign_and_send(words);
    if (words[0] == "stop" && sent.refusal.empty()) {
        stopped_at_ = Clock::now();
    }
    return sent;
}

Sent Commander::sign_and_send(const std::vector<std::string> &words)
{
    std::vector<const char *> texts(words.size());
    std::transform(words.begin(), words.end(), texts.begin(), [](const auto &word) { return word.c_str(); });
    ale_command_t command;
    if (ale_command_from_words(texts.data(), static_cast<uint32_t>(texts.size()), &command) < 0) {
        return refused("too many words, or one that is too long");
    }
    const bool stop = words[0] == "stop";
    const std::string in_doubt = doubt();
    if (!in_doubt.empty() && (!stop || end_.robot().empty())) {
        return {0, in_doubt};
    }
    try {
        const std::vector<int64_t> numbers =
            end_.send(command, words[0] == "drive" ? drive_life_us : life_us);
        if (numbers.empty()) {
            return refused("a word that is too long");
        }
        stop_ = stop ? end_.made() : stop_;
        return {numbers.front(), {}};
    } catch (const std::runtime_error &error) {
        return refused(error.what());
    }
}

} // namespace console
