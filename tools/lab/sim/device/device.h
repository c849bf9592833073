/* A scanner as seen through its line: bytes in, bytes out. Pure on bytes and times of the caller; no line, no
 * clock, no measurement of its own. */
#ifndef ALE_LAB_SIM_DEVICE_H
#define ALE_LAB_SIM_DEVICE_H

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/sim/device/scanner.h"
#include "lab/sim/device/sweep.h"

namespace sim
{

struct Reply {
    std::string bytes;
    std::optional<int64_t> turn_start_us; /* of the turn that it holds, or begins, microseconds of play */
    bool measured = false;                /* there are ranges in it: what faults on the line befall */
};

class Device
{
  public:
    Device() = default;
    Device(const Device &) = delete;
    Device &operator=(const Device &) = delete;
    virtual ~Device() = default;

    /* As after the supply came on. */
    virtual void power_up(int64_t now_us) = 0;

    virtual void receive(std::string_view bytes, int64_t now_us) = 0;
    /* Replies that are due by now. */
    virtual std::vector<Reply> answer(int64_t now_us) = 0;
    /* When answer() will have something to say by itself; nothing: not before a command or a turn. */
    virtual std::optional<int64_t> answer_due_us() const = 0;

    /* A turn, or a part of one, is over; device_start_us is when it began, on the clock of now_us. */
    virtual std::vector<Reply> turn(const Turn &, int64_t /* device_start_us */)
    {
        return {};
    }
    virtual std::vector<Reply> sweep(const Sweep &, int64_t /* device_start_us */)
    {
        return {};
    }

    /* The play begins: somebody has asked for ranges, or listens to a device that sends unasked. */
    virtual bool wanted(bool connected) const = 0;
    virtual bool streaming() const = 0;
    /* Bit/s that a serial line must have; 0: any. */
    virtual int32_t rate() const
    {
        return 0;
    }

    /* A fault of the device itself. */
    virtual void break_stream(const std::string & /* status */)
    {
    }
    virtual void power_up_in_scip1(int64_t now_us)
    {
        power_up(now_us);
    }
    virtual void stall(int64_t /* until_us */)
    {
    }
};

} // namespace sim

#endif
