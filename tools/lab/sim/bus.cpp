#include "lab/sim/bus.h"

#include <cmath>
#include <stdexcept>

#include <poll.h>

#include "lab/sim/units.h"

extern "C" {
#include "lcm/url.h"
#include "lcmtypes_ale_drive_t.h"
}

namespace sim
{

namespace
{

constexpr int64_t dead_man_us = 500000;
constexpr char drive_channel[] = "ALE_DRIVE";

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
    const char *joined = ale_lcm_url(url.c_str(), error);
    if (!joined) {
        throw std::runtime_error(error);
    }
    lcm_.reset(lcm_create(joined));
    if (!lcm_ || !lcm_subscribe(lcm_.get(), drive_channel, take, this)) {
        throw std::runtime_error("LCM: cannot listen to ALE_DRIVE");
    }
}

int DriveIn::descriptor() const
{
    return lcm_get_fileno(lcm_.get());
}

void DriveIn::take(const lcm_recv_buf_t *message, const char *, void *self)
{
    auto &drive = *static_cast<DriveIn *>(self);
    /* The C type: the generated C++ reads floats through integers, which an optimiser may take apart. */
    lcmtypes_ale_drive_t set_point = {};
    const int size = static_cast<int>(message->data_size);
    if (lcmtypes_ale_drive_t_decode(message->data, 0, size, &set_point) == size &&
        std::isfinite(set_point.v) && std::isfinite(set_point.w)) {
        drive.command_ = {set_point.v, set_point.w};
        drive.taken_us_ = drive.now_us_;
    }
}

void DriveIn::receive(int64_t now_us)
{
    now_us_ = now_us;
    pollfd ready = {descriptor(), POLLIN, 0};
    while (poll(&ready, 1, 0) > 0) {
        lcm_handle(lcm_.get());
    }
}

Twist DriveIn::command(int64_t now_us) const
{
    return now_us - taken_us_ <= dead_man_us ? command_ : Twist{};
}

} // namespace sim
