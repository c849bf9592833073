#include "operator/console/commander.h"

#include <algorithm>
#include <stdexcept>

namespace console
{

namespace
{

constexpr std::chrono::seconds driving_lasts{2};

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

Commander::Commander(const std::string &lcm_url, const std::string &key_file)
{
    if (key_file.empty()) {
        return;
    }
    char error[ALE_KEYS_ERROR];
    if (ale_secret_key_load(key_file.c_str(), &operator_.key, error) < 0) {
        throw std::runtime_error(error);
    }
    char bus_error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(lcm_url.c_str(), bus_error));
    if (!bus_) {
        throw std::runtime_error(bus_error);
    }
}

void Commander::saw(const ale::status_t &status)
{
    const std::lock_guard lock(mutex_);
    ale_operator_saw(&operator_, status.robot.c_str(), status.boot, status.utime, host_us());
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

Sent Commander::send(uint64_t page, const std::vector<std::string> &words)
{
    const std::lock_guard lock(mutex_);
    if (!bus_) {
        return refused("this console has no key: it only watches (ale-console --keys FILE)");
    }
    if (words.empty()) {
        return refused("a command without a word");
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
    uint8_t bytes[ALE_COMMAND_BYTES];
    const int64_t life = words[0] == "drive" ? drive_life_us : life_us;
    const size_t count = ale_operator_command(&operator_, host_us(), life, &command, bytes);
    if (count == 0) {
        return refused("no robot has been heard yet");
    }
    if (ale_bus_send_command(bus_.get(), bytes, count) < 0) {
        return refused("LCM does not take the command");
    }
    return {command.counter, {}};
}

} // namespace console
