#include "lab/sim/write_recording.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "lab/sim/device/ldrobot_device.h"
#include "lab/sim/progress.h"
#include "lab/sim/tum.h"
#include "lab/sim/units.h"

extern "C" {
#include "scanner/rotary/protocol.h"
#include "scanner/rplidar/rplidar.h"
#include "store/recording.h"
}

namespace sim
{

namespace
{

constexpr int64_t begin_us = 1000000; /* the robot's clock when the play begins */

class Recording
{
  public:
    explicit Recording(const std::string &path) : path_(path)
    {
        check(ale_recording_create(&recording_, path.c_str()));
    }
    void write(ale_chunk_kind_t kind, int64_t play_us, const std::string &bytes)
    {
        check(ale_recording_write(&recording_, kind, begin_us + play_us, bytes.data(),
                                  static_cast<uint32_t>(bytes.size())));
    }
    void write(const OdometryReport &report)
    {
        const ale_odometry_t sample = {begin_us + report.stamp_us, core_pose(report.pose)};
        check(ale_recording_odometry(&recording_, begin_us + report.stamp_us, &sample));
    }
    void close()
    {
        check(ale_recording_close(&recording_));
    }

  private:
    void check(int result) const
    {
        if (result < 0) {
            throw std::runtime_error(path_ + ": " + std::strerror(errno));
        }
    }

    std::string path_;
    ale_recording_t recording_{};
};

std::unique_ptr<Device> device_of(const Sensor &sensor)
{
    if (sensor.family == SensorFamily::ldrobot) {
        return std::make_unique<LdrobotDevice>();
    }
    return std::make_unique<RplidarDevice>(sensor.rplidar);
}

void receive(Recording &recording, const std::vector<Reply> &replies, int64_t play_us)
{
    for (const Reply &reply : replies) {
        recording.write(ALE_CHUNK_RECEIVED, play_us, reply.bytes);
    }
}

/* Whether the client takes one of these for the answer to what it asked. */
bool is_answered(ale_rplidar_t &client, const std::vector<Reply> &replies)
{
    ale_rotary_packet_t packet;
    bool answered = false;
    for (const Reply &reply : replies) {
        const auto *bytes = reinterpret_cast<const uint8_t *>(reply.bytes.data());
        const auto count = static_cast<uint32_t>(reply.bytes.size());
        for (uint32_t used = 0; used < count && !answered;) {
            used += ale_rplidar_protocol.parse(&client, bytes + used, count - used, &packet);
            answered = packet.kind == ALE_PACKET_ANSWER;
        }
    }
    return answered;
}

/* The driver and the device, until the scan begins. */
void start_rplidar(Device &device, Recording &recording)
{
    const auto client = std::make_unique<ale_rplidar_t>();
    ale_rplidar_protocol.begin(client.get());
    ale_rotary_request_t request;
    bool answered = true;
    do {
        request = ale_rplidar_protocol.next(client.get(), !answered);
        if (request.gives_up) {
            throw std::logic_error("the simulated scanner does not answer the driver");
        }
        const std::string bytes(reinterpret_cast<const char *>(request.bytes), request.count);
        if (!bytes.empty()) {
            recording.write(ALE_CHUNK_SENT, 0, bytes);
            device.receive(bytes, 0);
        }
        const std::vector<Reply> replies = device.answer(0);
        receive(recording, replies, 0);
        answered = is_answered(*client, replies);
    } while (!request.streams);
}

void start(Device &device, const Sensor &sensor, Recording &recording)
{
    device.power_up(0);
    if (sensor.family == SensorFamily::rplidar) {
        start_rplidar(device, recording);
    }
}

} // namespace

uint32_t write_recording(WorldSource &source, const Sensor &sensor, const std::string &path, std::FILE *truth)
{
    Recording recording(path);
    const std::unique_ptr<Device> device = device_of(sensor);
    Progress progress;
    uint32_t turns = 0;
    start(*device, sensor, recording);
    while (const auto due_us = source.due_us()) {
        const Event event = source.next();
        if (const auto *report = std::get_if<OdometryReport>(&event)) {
            recording.write(*report);
            if (truth) {
                write_tum(truth, begin_us + report->stamp_us,
                          source.truth(report->stamp_us).value_or(Pose{}));
            }
        } else if (const auto *sweep = std::get_if<Sweep>(&event)) {
            receive(recording, device->sweep(*sweep, std::llround(sweep->start_us)), *due_us);
            turns += sweep->begins_turn ? 1 : 0;
            progress.show(*due_us, turns);
        }
    }
    recording.close();
    return turns;
}

} // namespace sim
