#include "operator/console/commander.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace console
{

namespace
{

constexpr std::chrono::seconds driving_lasts{2};
constexpr std::chrono::seconds stop_lasts{2};

/* A set point that was held back on its way is worse than none; anything else may take its time. */
constexpr int64_t drive_life_us = 500000;
constexpr int64_t life_us = 5000000;

int64_t host_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(Commander::Clock::now().time_since_epoch())
        .count();
}

Sent refused(const char *why)
{
    return {0, why};
}

} // namespace

Commander::Commander(const Credentials &credentials)
{
    operator_.robots = feed::believed(credentials.robots_file, credentials.key_file);
    std::snprintf(operator_.wanted, sizeof operator_.wanted, "%s", credentials.robot.c_str());
    if (credentials.key_file.empty()) {
        return;
    }
    char error[ALE_KEYS_ERROR];
    if (ale_secret_key_load(credentials.key_file.c_str(), &operator_.key, error) < 0) {
        throw std::runtime_error(error);
    }
    char bus_error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(credentials.lcm_url.c_str(), bus_error));
    if (!bus_) {
        throw std::runtime_error(bus_error);
    }
}

bool Commander::saw(const ale::status_t &status)
{
    const std::lock_guard lock(mutex_);
    if (!believes()) {
        return ale_operator_saw(&operator_, status.robot.c_str(), status.boot, status.utime, host_us());
    }
    unbelieved_ = status.robot;
    return operator_.present.robot[0] == '\0';
}

std::optional<ale::vouched_t> Commander::saw_vouched(const uint8_t *bytes, size_t count)
{
    const std::lock_guard lock(mutex_);
    auto message = feed::vouched_by(operator_.robots, bytes, count);
    const ale_start_t start = message ? feed::start_of(*message) : ale_start_t{};
    const int64_t boot = operator_.present.boot;
    if (message && !ale_operator_saw_vouched(&operator_, &start, host_us())) {
        message.reset();
    }
    stop_anew(boot);
    return message;
}

/* A stop that was made for what turns out to be a memory of the robot is made again for the robot itself. */
void Commander::stop_anew(int64_t boot_before)
{
    if (bus_ && operator_.present.boot != boot_before && Clock::now() - stopped_at_ < stop_lasts) {
        sign_and_send({"stop"});
    }
}

/* Why it cannot be known who is spoken to; empty: it is known. */
std::string Commander::doubt() const
{
    const char *rival = ale_operator_rival(&operator_, host_us());
    if (operator_.present.robot[0] == '\0') {
        return unbelieved_.empty()
                   ? "no robot has been heard yet"
                   : unbelieved_ + " is heard, but no robot whose key is known vouches for it";
    }
    if (rival && std::strcmp(rival, operator_.present.robot) == 0) {
        return std::string("two robots call themselves ") + rival + ": they obey STOP alone";
    }
    return rival ? std::string("two robots are heard, ") + operator_.present.robot + " and " + rival +
                       ": choose one (ale-console --robot NAME)"
                 : "";
}

std::vector<std::string> Commander::warnings()
{
    const std::lock_guard lock(mutex_);
    std::vector<std::string> lines;
    const std::string in_doubt = doubt();
    if (!in_doubt.empty()) {
        lines.push_back("Not sure who is heard: " + in_doubt + ".");
    }
    if (bus_ && !believes()) {
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
    if (!bus_) {
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
    return sign_and_send(words);
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
    if (!in_doubt.empty() && (!stop || operator_.present.robot[0] == '\0')) {
        return {0, in_doubt};
    }
    uint8_t bytes[ALE_COMMAND_BYTES];
    const int64_t life = words[0] == "drive" ? drive_life_us : life_us;
    const size_t count = ale_operator_command(&operator_, host_us(), life, &command, bytes);
    if (count == 0) {
        return refused("a word that is too long");
    }
    if (ale_bus_send_command(bus_.get(), bytes, count) < 0) {
        return refused("LCM does not take the command");
    }
    if (stop) {
        stopped_at_ = Clock::now(); /* what is driven after it does not take it back */
        send_to_others(command, life);
    }
    return {command.counter, {}};
}

/* A stop reaches the robot, whichever of the starts that were heard is the true one. */
void Commander::send_to_others(const ale_command_t &command, int64_t life)
{
    uint8_t bytes[ALE_COMMAND_BYTES];
    for (int other = 0; other < ALE_OPERATOR_OTHERS; other++) {
        ale_command_t same = command;
        const size_t count = ale_operator_command_other(&operator_, other, host_us(), life, &same, bytes);
        if (count > 0) {
            ale_bus_send_command(bus_.get(), bytes, count);
        }
    }
}

} // namespace console
