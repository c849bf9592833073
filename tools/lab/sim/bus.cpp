#include "lab/sim/bus.h"

#include <cmath>
#include <stdexcept>

#include "lab/sim/units.h"

extern "C" {
#include "lcmtypes_ale_drive_t.h"
}

namespace sim
{

namespace
{

constexpr int64_t dead_man_us = 500000;
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

DriveIn::DriveIn(const std::string &url)
{
    char error[ALE_LCM_URL_ERROR];
    wire_.reset(ale_wire_open(url.c_str(), error));
    if (!wire_) {
        throw std::runtime_error(error);
    }
    if (ale_wire_subscribe(wire_.get(), ALE_CHANNEL_DRIVE, take, this) < 0) {
        throw std::runtime_error("LCM: cannot listen to ALE_DRIVE");
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
}

Twist DriveIn::command(int64_t now_us) const
{
    return now_us - taken_us_ <= dead_man_us ? command_ : Twist{};
}

} // namespace sim
