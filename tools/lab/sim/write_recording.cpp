#include "lab/sim/write_recording.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "lab/sim/device/ldrobot_device.h"
#include "lab/sim/progress.h"
#include "lab/sim/tum.h"

extern "C" {
#include "base/trig.h"
#include "store/recording.h"
}

namespace sim
{

namespace
{

constexpr int64_t begin_us = 1000000; /* the robot's clock when the play begins */

/* What a client sends to an RPLIDAR until it scans in its usual way. */
std::vector<std::string> requests_to(const RplidarModel &model)
{
    std::vector<std::string> requests = {{"\xa5\x25", 2}, {"\xa5\x50", 2}};
    if (model.has_configuration) {
        const bool standard = model.typical == RplidarScan::standard;
        const std::string mode = standard ? std::string("\0\0", 2) : std::string("\1\0", 2);
        const std::string entry = std::string("\xa5\x84\x06\x71\0\0\0", 7) + mode;
        requests.push_back(entry);
    } else {
        requests.emplace_back("\xa5\x59", 2);
    }
    if (model.motor_by_command) {
        requests.emplace_back("\xa5\xf0\x02\x94\x02", 5);
    }
    if (model.typical == RplidarScan::standard) {
        requests.emplace_back("\xa5\x20", 2);
    } else {
        requests.emplace_back("\xa5\x82\x05\1\0\0\0\0", 8);
    }
    for (std::string &request : requests) {
        char sum = 0;
        for (const char c : request) {
            sum = static_cast<char>(sum ^ c);
        }
        request += request.size() > 2 ? std::string(1, sum) : "";
    }
    return requests;
}

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
        const ale_odometry_t sample = {
            begin_us + report.stamp_us,
            {static_cast<int32_t>(std::lround(report.pose.x * 1e6)),
             static_cast<int32_t>(std::lround(report.pose.y * 1e6)),
             static_cast<uint32_t>(ale_nrad_to_bam(std::llround(wrapped(report.pose.theta) * 1e9)))}};
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

void start(Device &device, const Sensor &sensor, Recording &recording)
{
    device.power_up(0);
    if (sensor.family != SensorFamily::rplidar) {
        return;
    }
    for (const std::string &request : requests_to(sensor.rplidar)) {
        recording.write(ALE_CHUNK_SENT, 0, request);
        device.receive(request, 0);
        receive(recording, device.answer(0), 0);
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
