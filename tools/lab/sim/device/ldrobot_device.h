/* An LDROBOT LD06 (LD19, STL-19P) as seen through its line: it sends packets of twelve points unasked, 230400
 * bit/s, and hears nothing. Written from LDROBOT's development manual, apart from the driver. */
#ifndef ALE_LAB_SIM_LDROBOT_DEVICE_H
#define ALE_LAB_SIM_LDROBOT_DEVICE_H

#include "lab/sim/device/device.h"

namespace sim
{

class LdrobotDevice final : public Device
{
  public:
    void power_up(int64_t now_us) override;
    void receive(std::string_view, int64_t) override
    {
    }
    std::vector<Reply> answer(int64_t) override
    {
        return {};
    }
    std::optional<int64_t> answer_due_us() const override
    {
        return std::nullopt;
    }
    std::vector<Reply> sweep(const Sweep &sweep, int64_t device_start_us) override;
    bool wanted(bool connected) const override
    {
        return connected;
    }
    bool streaming() const override
    {
        return true;
    }
    int32_t rate() const override
    {
        return 230400;
    }
    void stall(int64_t until_us) override
    {
        stalled_until_us_ = until_us;
    }

  private:
    int64_t clock_origin_us_ = 0;
    int64_t stalled_until_us_ = 0;
    double stalled_at_ = 0; /* degrees */
};

} // namespace sim

#endif
