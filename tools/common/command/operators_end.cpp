#include "common/command/operators_end.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "common/feed/vouched.h"

namespace command
{

namespace
{

int64_t host_us()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

} // namespace

OperatorsEnd::OperatorsEnd(const ale_keys_t &robots, const std::string &wanted)
{
    end_.robots = robots;
    std::snprintf(end_.wanted, sizeof end_.wanted, "%s", wanted.c_str());
}

void OperatorsEnd::take_key(const std::string &url, const ale_secret_key_t &key)
{
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(url.c_str(), error));
    if (!bus_) {
        throw std::runtime_error(error);
    }
    end_.key = key;
}

bool OperatorsEnd::saw(const ale::status_t &status)
{
    return ale_operator_saw(&end_, status.robot.c_str(), status.boot, status.utime, host_us());
}

bool OperatorsEnd::saw(const ale::vouched_t &message)
{
    const ale_start_t start = feed::start_of(message);
    return ale_operator_saw_vouched(&end_, &start, host_us());
}

std::string OperatorsEnd::rival() const
{
    const char *name = ale_operator_rival(&end_, host_us());
    return name ? name : "";
}

std::vector<std::string> OperatorsEnd::heard() const
{
    std::vector<std::string> names;
    if (!robot().empty()) {
        names.push_back(robot());
    }
    for (const ale_start_t &other : end_.other) {
        const bool lately = other.robot[0] != '\0' && host_us() - other.host_us <= ALE_OPERATOR_SILENCE_US;
        if (lately && std::find(names.begin(), names.end(), other.robot) == names.end()) {
            names.emplace_back(other.robot);
        }
    }
    return names;
}

void OperatorsEnd::publish(const uint8_t *bytes, size_t count)
{
    if (ale_bus_send_command(bus_.get(), bytes, count) < 0) {
        throw std::runtime_error("LCM does not take the command");
    }
}

std::vector<int64_t> OperatorsEnd::send(const ale_command_t &command, int64_t life_us)
{
    uint8_t bytes[ALE_COMMAND_BYTES];
    ale_command_t made = command;
    const int64_t now_us = host_us();
    const size_t count = ale_operator_command(&end_, now_us, life_us, &made, bytes);
    if (count == 0) {
        return {};
    }
    publish(bytes, count);
    std::vector<int64_t> numbers = {made.counter};
    for (int other = 0; end_.made.stop && other < ALE_OPERATOR_OTHERS; other++) {
        ale_command_t same = command;
        const size_t more = ale_operator_command_other(&end_, other, now_us, life_us, &same, bytes);
        if (more > 0) {
            publish(bytes, more);
            numbers.push_back(same.counter);
        }
    }
    return numbers;
}

bool OperatorsEnd::was_misled(const ale_made_t &made) const
{
    return ale_operator_was_misled(&end_, &made, host_us());
}

} // namespace command
