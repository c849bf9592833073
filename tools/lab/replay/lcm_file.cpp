#include "lab/replay/lcm_file.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <endian.h>

namespace ale
{

namespace
{

/* Event: u32 sync, i64 number, i64 microseconds, i32 lengths of channel and data, these; big endian. A
 * message: its fingerprint, then its utime. */
constexpr size_t header_bytes = 28;
constexpr size_t stamp_at = 12;
constexpr size_t channel_length_at = 20;
constexpr size_t data_length_at = 24;
constexpr size_t utime_at = 8;
constexpr uint32_t maps_every = 10;
constexpr int64_t graphs_apart_us = 1000000;
constexpr int64_t graph_again_us = 10000000;

using Header = std::array<char, header_bytes>;

uint32_t length_at(const Header &header, size_t at)
{
    uint32_t value;
    std::memcpy(&value, header.data() + at, sizeof value);
    return be32toh(value);
}

/* liblcm stamps an event with the present; here it is the time of the message. How many there are. */
uint64_t stamp_events(std::fstream &file)
{
    constexpr uint32_t stamp_bytes = 8;
    std::array<char, stamp_bytes> utime{};
    Header header{};
    uint64_t events = 0;
    std::streamoff at = 0;
    while (file.seekg(at).read(header.data(), header.size())) {
        const std::streamoff data =
            at + static_cast<std::streamoff>(header_bytes + length_at(header, channel_length_at));
        file.seekg(data + static_cast<std::streamoff>(utime_at)).read(utime.data(), stamp_bytes);
        file.seekp(at + static_cast<std::streamoff>(stamp_at)).write(utime.data(), stamp_bytes);
        at = data + static_cast<std::streamoff>(length_at(header, data_length_at));
        events += file.seekg(at - 1).get() != std::fstream::traits_type::eof();
    }
    file.clear();
    return events;
}

std::string url_of(const std::string &path)
{
    return "file://" + std::filesystem::absolute(path).string() + "?mode=w";
}

} // namespace

LcmFile::LcmFile(const std::string &path) : path_(path), bus_(nullptr, ale_bus_close)
{
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(url_of(path).c_str(), error));
    if (!bus_) {
        throw std::runtime_error(path + ": cannot be written");
    }
}

void LcmFile::fail() const
{
    throw std::runtime_error(path_ + ": not all of it could be written; is the disk full?");
}

void LcmFile::took(int result)
{
    if (result < 0) {
        fail();
    }
    sent_++;
}

void LcmFile::put_scan(const ale_scan_t &scan, uint32_t number, const ale_pose_t &sensor)
{
    took(ale_bus_send_scan(bus_.get(), &scan, scan.stamp_us, number, sensor));
}

void LcmFile::put_odometry(const ale_odometry_t &sample)
{
    took(ale_bus_send_exact_odometry(bus_.get(), &sample));
    took(ale_bus_send_odometry(bus_.get(), &sample));
}

void LcmFile::put_estimate(const ale_estimate_t &estimate)
{
    ale_pose_report_t report{};
    report.estimate = estimate;
    report.first_beam_us = report.arrival_us = report.sent_us = estimate.stamp_us;
    took(ale_bus_send_pose(bus_.get(), &report));
    took(ale_bus_send_tracking(bus_.get(), &estimate));
}

void LcmFile::put_features(const ale_features_t &features, int64_t stamp_us, uint32_t number,
                           const ale_pose_t &sensor)
{
    took(ale_bus_send_features(bus_.get(), &features, stamp_us, number, sensor));
}

void LcmFile::put_map(const OfflineSlam &slam, int64_t stamp_us)
{
    if (scans_without_map_++ % maps_every != 0) {
        return;
    }
    slam.copy_map(map_.get());
    if (map_->version == sent_version_) {
        return;
    }
    sent_version_ = map_->version;
    for (int16_t part = 0; part < ale_map_pieces_parts(map_.get()); part++) {
        took(ale_bus_send_map_pieces(bus_.get(), map_.get(), stamp_us, part));
    }
    for (int16_t part = 0; part < ale_map_parts(map_.get()); part++) {
        took(ale_bus_send_map_part(bus_.get(), map_.get(), stamp_us, part));
    }
}

void LcmFile::send_graph(const Loops &loops, int64_t stamp_us)
{
    if (!loops.copy_graph(graph_.get())) {
        return;
    }
    sent_graph_ = loops.graph_version();
    graph_sent_us_ = stamp_us;
    took(ale_bus_send_graph(bus_.get(), graph_.get(), stamp_us, sent_graph_));
}

/* As the firmware does (telemetry/graph_publisher.h), by the time of the log; a clock that is set back must
 * not silence it. */
void LcmFile::put_graph(const OfflineSlam &slam, int64_t stamp_us)
{
    const Loops *loops = slam.loops();
    if (!loops || loops->graph_version() == 0) {
        return;
    }
    const int64_t since_us = std::abs(stamp_us - graph_sent_us_);
    const bool due = loops->graph_version() != sent_graph_ && since_us >= graphs_apart_us;
    if (sent_graph_ == 0 || due || since_us >= graph_again_us) {
        send_graph(*loops, stamp_us);
    }
}

void LcmFile::close(const OfflineSlam &slam)
{
    const Loops *loops = slam.loops();
    if (loops && loops->graph_version() != sent_graph_) {
        send_graph(*loops, slam.trajectory().back().stamp_us);
    }
    bus_.reset();
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    const uint64_t events = stamp_events(file);
    file.close();
    if (!file || events != sent_) { /* liblcm has no word for a disk that is full */
        fail();
    }
}

} // namespace ale
