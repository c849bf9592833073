/* Brings it all together: the source's turns to the device, the device's bytes to the line, at their
 * time; faults when they are due. The play begins when a client first asks for ranges. */
#ifndef ALE_LAB_SIM_SIMULATOR_H
#define ALE_LAB_SIM_SIMULATOR_H

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "lab/sim/bus.h"
#include "lab/sim/clock.h"
#include "lab/sim/device/scip_device.h"
#include "lab/sim/device/sensors.h"
#include "lab/sim/faults.h"
#include "lab/sim/line/line.h"
#include "lab/sim/line/port.h"
#include "lab/sim/source.h"

namespace sim
{

struct SimulatorOptions {
    std::string link;
    int32_t tcp_port = 0; /* goes before link */
    SensorFamily family = SensorFamily::urg;
    RplidarModel rplidar;
    Protocol protocol = Protocol::scip2;
    double speed = 1;
    int64_t baud_limit = 0; /* bytes a second, 0: none */
    int64_t command_interval_us = 0;
    std::string faults;
    uint64_t seed = 1;
};

/* What has happened so far. */
struct Tally {
    uint64_t scans = 0;     /* turns of the source */
    uint64_t sent = 0;      /* replies with ranges, damaged ones too */
    uint64_t damaged = 0;   /* of these */
    uint64_t swallowed = 0; /* the line was silent, unplugged or too slow */
};

class Simulator
{
  public:
    /* odometry, drive and truth may be null. They must live as long as the simulator. */
    Simulator(Source &source, const SimulatorOptions &options, OdometryOut *odometry, DriveIn *drive,
              std::FILE *truth);

    /* Runs until the source ends or somebody says stop. */
    void run(bool (*stop)());

    const Tally &tally() const
    {
        return tally_;
    }

  private:
    void play(int64_t now_us);
    void play_turn(const Turn &turn, int64_t now_us);
    void play_sweep(const Sweep &sweep, int64_t now_us);
    bool is_swallowed(int64_t now_us);
    std::string at_the_clients_rate(const std::string &bytes) const;
    void send(const std::vector<Reply> &replies, int64_t now_us);
    void strike(const Fault &fault, int64_t now_us);
    void listen(int64_t now_us);
    void end_outage(int64_t now_us);
    void write_truth(int64_t play_us);
    int64_t next_us(int64_t now_us);
    void let_client_finish();

    Source &source_;
    OdometryOut *odometry_;
    DriveIn *drive_;
    std::FILE *truth_;
    Clock clock_;
    Faults faults_;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Port> port_;
    Line line_;
    Tally tally_;
    std::optional<int64_t> play_start_us_;
    int64_t outage_until_us_ = 0; /* silent or unplugged */
    bool over_ = false;
};

} // namespace sim

#endif
