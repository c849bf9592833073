/* A SLAMTEC RPLIDAR as seen through its line: requests in, answers and measurements out. Written from
 * SLAMTEC's rplidar_sdk, apart from the driver. */
#ifndef ALE_LAB_SIM_RPLIDAR_DEVICE_H
#define ALE_LAB_SIM_RPLIDAR_DEVICE_H

#include <deque>

#include "lab/sim/device/device.h"

namespace sim
{

/* Codings of measurements, by the type of their answer. */
enum class RplidarScan : uint8_t { none = 0, standard = 0x81, express = 0x82, dense = 0x85 };

/* What tells one model from another. */
struct RplidarModel {
    uint8_t model = 0x18;
    uint16_t firmware = 0x0114; /* 1.20 */
    uint8_t hardware = 5;
    int32_t baud = 115200;
    RplidarScan typical = RplidarScan::express; /* the scan that it calls its usual one */
    bool has_configuration = false;             /* firmware 1.24 and later: GET_LIDAR_CONF */
    bool motor_by_command = false;              /* it stands until it is told to turn */
    double standard_us = 500;                   /* of a sample in the standard scan, */
    double express_us = 250;                    /* and in the others */
    int32_t max_m = 12;
};

class RplidarDevice final : public Device
{
  public:
    explicit RplidarDevice(const RplidarModel &model);

    void power_up(int64_t now_us) override;
    void receive(std::string_view bytes, int64_t now_us) override;
    std::vector<Reply> answer(int64_t now_us) override;
    std::optional<int64_t> answer_due_us() const override;
    std::vector<Reply> sweep(const Sweep &sweep, int64_t device_start_us) override;
    bool wanted(bool connected) const override;
    bool streaming() const override;
    int32_t rate() const override
    {
        return model_.baud;
    }
    void break_stream(const std::string &status) override;
    void stall(int64_t until_us) override
    {
        stalled_until_us_ = until_us;
    }

  private:
    size_t request_size() const;
    void obey();
    void begin(RplidarScan scan);
    void end();
    void boot();
    void begin_standard();
    void begin_other();
    void set_motor();
    void tell_info();
    void tell_health();
    void tell_rates();
    void tell_board();
    void tell_configuration();
    RplidarScan other_scan() const;
    std::string entry(uint32_t number, bool is_standard) const;
    std::string piece();
    std::string node_of(const Echo &echo);

    RplidarModel model_;
    RplidarScan scan_ = RplidarScan::none;
    bool turning_ = false;
    bool wanted_ = false;
    bool anew_ = false; /* the next piece is the scan's first one */
    uint8_t error_ = 0;
    int64_t deaf_until_us_ = 0;
    int64_t stalled_until_us_ = 0;
    uint32_t points_ = 0;
    double last_clockwise_ = 0;
    std::string heard_;
    std::deque<std::string> answers_;
    std::vector<Echo> waiting_; /* points that do not fill a piece yet */
};

} // namespace sim

#endif
