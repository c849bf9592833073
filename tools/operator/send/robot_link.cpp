#include "operator/send/robot_link.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace send
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr int look_ms = 20;
constexpr int64_t ppm = 1000000;
constexpr int64_t much_us = 500000; /* more than a message is held up on its way */

bool is_stop(const ale_command_t &command)
{
    return std::strcmp(command.verb, "stop") == 0;
}

int64_t host_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

} // namespace

RobotLink::RobotLink(const std::string &url, const std::string &robot, const ale_secret_key_t &key,
                     const ale_keys_t &robots)
    : feed_(url)
{
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(url.c_str(), error));
    if (!bus_) {
        throw std::runtime_error(error);
    }
    operator_.key = key;
    operator_.robots = robots;
    std::snprintf(operator_.wanted, sizeof operator_.wanted, "%s", robot.c_str());
    feed_.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &status) { take(status); });
    feed_.on_bytes("ALE_VOUCHED", [this](const uint8_t *bytes, size_t count) { take_vouched(bytes, count); });
}

void RobotLink::take(const ale::status_t &status)
{
    if (ale_operator_saw(&operator_, status.robot.c_str(), status.boot, status.utime, host_us())) {
        status_ = status;
    }
    if (is_vouched() && (operator_.wanted[0] == '\0' || status.robot == operator_.wanted)) {
        unbelieved_ = status;
    }
}

void RobotLink::take_vouched(const uint8_t *bytes, size_t count)
{
    const auto message = feed::vouched_by(operator_.robots, bytes, count);
    const ale_start_t start = message ? feed::start_of(*message) : ale_start_t{};
    if (message && ale_operator_saw_vouched(&operator_, &start, host_us())) {
        status_ = message->status;
    }
}

std::string RobotLink::rival() const
{
    const char *name = ale_operator_rival(&operator_, host_us());
    return name ? name : "";
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

void RobotLink::send(const uint8_t *bytes, size_t count)
{
    if (ale_bus_send_command(bus_.get(), bytes, count) < 0) {
        throw std::runtime_error("LCM does not take the command");
    }
}

void RobotLink::command(ale_command_t command, int64_t life_us)
{
    uint8_t bytes[ALE_COMMAND_BYTES];
    const int64_t now_us = host_us();
    const size_t count = ale_operator_command(&operator_, now_us, life_us, &command, bytes);
    if (count == 0) {
        throw std::runtime_error("no robot to command");
    }
    send(bytes, count);
    last_ = command;
    last_host_us_ = now_us;
    counters_.push_back(command.counter);
    for (int other = 0; is_stop(command) && other < ALE_OPERATOR_OTHERS; other++) {
        ale_command_t same = command;
        const size_t more = ale_operator_command_other(&operator_, other, now_us, life_us, &same, bytes);
        if (more > 0) {
            send(bytes, more);
            counters_.push_back(same.counter);
        }
    }
}

bool RobotLink::was_misled() const
{
    const int64_t now_us = host_us();
    const int64_t utime = ale_operator_utime(&operator_, now_us);
    const int64_t rate = operator_.present.rate_ppm > 0 ? operator_.present.rate_ppm : ppm;
    const int64_t jump_us = utime - last_.utime - (now_us - last_host_us_) * rate / ppm;
    const bool other_start = operator_.present.boot != last_.boot;
    return other_start || (jump_us > much_us && (is_stop(last_) || utime > last_.expiry_utime));
}

bool RobotLink::answered() const
{
    return status_ && status_->command_operator == operator_.key.name &&
           std::find(counters_.begin(), counters_.end(), status_->command_counter) != counters_.end();
}

bool RobotLink::drives_since() const
{
    return status_ && status_->command_operator == operator_.key.name &&
           status_->command_counter > last_.counter && status_->command_obeyed &&
           status_->who_drives == operator_.key.name;
}

} // namespace send
