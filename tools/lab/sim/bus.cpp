#include "lab/sim/bus.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <sodium.h>

#include "lab/sim/units.h"

extern "C" {
#include "command/keys.h"
#include "lcmtypes_ale_drive_t.h"
}

namespace sim
{

namespace
{

constexpr int64_t dead_man_us = 500000;
constexpr int64_t keyed_dead_man_us = int64_t{ALE_MOTOR_DEAD_MAN_MS} * 1000;
constexpr std::chrono::milliseconds ready_period{500};
constexpr double micro = 1e-6;
constexpr int most_datagrams = 256;

} // namespace

OdometryOut::OdometryOut(const std::string &url)
{
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(url.c_str(), error));
    if (!bus_) {
        throw std::runtime_error(error);
    }
}

void OdometryOut::publish(int64_t utime, const Pose &pose)
{
    const ale_odometry_t sample = {utime, core_pose(pose)};
    ale_bus_send_exact_odometry(bus_.get(), &sample);
    ale_bus_send_odometry(bus_.get(), &sample);
}

DriveIn::DriveIn(const std::string &url, const std::string &key_file)
{
    char error[ALE_LCM_URL_ERROR];
    wire_.reset(ale_wire_open(url.c_str(), error));
    if (!wire_) {
        throw std::runtime_error(error);
    }
    keyed_ = !key_file.empty();
    if (keyed_) {
        read_key(key_file);
    }
    const char *channel = keyed_ ? ALE_CHANNEL_DRIVE_KEYED : ALE_CHANNEL_DRIVE;
    if (ale_wire_subscribe(wire_.get(), channel, keyed_ ? take_keyed : take, this) < 0) {
        throw std::runtime_error(std::string("LCM: cannot listen to ") + channel);
    }
}

void DriveIn::read_key(const std::string &key_file)
{
    ale_drive_key_t key;
    char error[ALE_KEYS_ERROR];
    if (ale_drive_key_load(key_file.c_str(), &key, error) < 0) {
        throw std::runtime_error(error);
    }
    std::memcpy(motor_.key, key.key, sizeof motor_.key);
    randombytes_buf(&motor_.next, sizeof motor_.next);
}

/* For which start of the robot and of this end set points are to be. */
void DriveIn::say_ready()
{
    const auto now = std::chrono::steady_clock::now();
    if (now - ready_ >= ready_period) {
        uint8_t bytes[ALE_MOTOR_READY];
        const size_t count = ale_motor_ready(&motor_, bytes);
        ale_wire_send(wire_.get(), ALE_CHANNEL_DRIVE_READY, bytes, count);
        ready_ = now;
    }
}

void DriveIn::take_keyed(void *self, const char *, const uint8_t *bytes, size_t count)
{
    auto &drive = *static_cast<DriveIn *>(self);
    if (drive.now_us_ != too_early_us &&
        ale_motor_take(&drive.motor_, bytes, count, static_cast<uint32_t>(drive.now_us_ / 1000))) {
        drive.command_ = {drive.motor_.v_um_s * micro, drive.motor_.w_urad_s * micro};
        drive.taken_us_ = drive.now_us_;
    }
}

int DriveIn::descriptor() const
{
    return ale_wire_descriptor(wire_.get());
}

void DriveIn::take(void *self, const char *, const uint8_t *bytes, size_t count)
{
    auto &drive = *static_cast<DriveIn *>(self);
    /* The C type: the generated C++ reads floats through integers, which an optimiser may take apart. */
    lcmtypes_ale_drive_t set_point = {};
    const int size = static_cast<int>(count);
    if (lcmtypes_ale_drive_t_decode(bytes, 0, size, &set_point) == size && std::isfinite(set_point.v) &&
        std::isfinite(set_point.w)) {
        drive.command_ = {set_point.v, set_point.w};
        drive.taken_us_ = drive.now_us_;
    }
}

void DriveIn::receive(int64_t now_us)
{
    now_us_ = now_us;
    ale_wire_receive(wire_.get(), 0, most_datagrams);
    if (keyed_) {
        say_ready();
    }
}

Twist DriveIn::command(int64_t now_us) const
{
    return now_us - taken_us_ <= (keyed_ ? keyed_dead_man_us : dead_man_us) ? command_ : Twist{};
}

} // namespace sim
