#include "operator/send/robot_link.h"

#include <chrono>
#include <stdexcept>

namespace send
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr int look_ms = 20;

int64_t host_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

} // namespace

RobotLink::RobotLink(const std::string &url, const std::string &robot, const ale_secret_key_t &key)
    : robot_(robot), feed_(url)
{
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(url.c_str(), error));
    if (!bus_) {
        throw std::runtime_error(error);
    }
    operator_.key = key;
    feed_.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &status) { take(status); });
}

void RobotLink::take(const ale::status_t &status)
{
    if (robot_.empty()) {
        robot_ = status.robot;
    }
    if (status.robot == robot_) {
        ale_operator_saw(&operator_, status.robot.c_str(), status.boot, status.utime, host_us());
        status_ = status;
    }
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

int64_t RobotLink::command(ale_command_t command, int64_t life_us)
{
    uint8_t bytes[ALE_COMMAND_BYTES];
    const size_t count = ale_operator_command(&operator_, host_us(), life_us, &command, bytes);
    if (count == 0) {
        throw std::runtime_error("no robot to command");
    }
    if (ale_bus_send_command(bus_.get(), bytes, count) < 0) {
        throw std::runtime_error("LCM does not take the command");
    }
    return command.counter;
}

bool RobotLink::answered(int64_t counter) const
{
    return status_ && status_->command_operator == operator_.key.name && status_->command_counter >= counter;
}

} // namespace send
