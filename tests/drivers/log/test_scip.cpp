/* Recordings made chunk by chunk from replies as the protocol lays them out. */
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "files.hpp"
#include "log_text.hpp"

extern "C" {
#include "scanner/urg/scip_encode.h"
#include "store/recording.h"
}

using ale_test::read_bytes;

namespace
{

constexpr int beams = 682;
const char *const stream_echo = "MD0044072501000";

class Recording
{
  public:
    Recording()
    {
        EXPECT_EQ(ale_recording_create(&recording_, path_.c_str()), 0);
    }
    void put(ale_chunk_kind_t kind, int64_t stamp_us, const std::string &bytes)
    {
        EXPECT_EQ(ale_recording_write(&recording_, kind, stamp_us, bytes.data(),
                                      static_cast<uint32_t>(bytes.size())),
                  0);
    }
    ale_recording_t *file()
    {
        return &recording_;
    }
    std::string bytes()
    {
        EXPECT_EQ(ale_recording_close(&recording_), 0);
        return files::content(path_);
    }

  private:
    const files::TemporaryFolder folder_;
    const std::string path_ = folder_ / "recording";
    ale_recording_t recording_{};
};

std::string frame(int number, int32_t range_mm)
{
    std::string out(4096, '\0');
    int32_t values[beams];
    std::fill(values, values + beams, range_mm);
    ale_scip_writer_t writer = {reinterpret_cast<uint8_t *>(out.data()), out.size(), 0, false};
    ale_scip_put_echo(&writer, stream_echo);
    ale_scip_put_status(&writer, "99");
    ale_scip_put_stamp(&writer, static_cast<uint32_t>(5000 + 100 * number));
    ale_scip_put_values(&writer, ALE_SCIP_2, values, beams, 3);
    ale_scip_put_end(&writer);
    out.resize(writer.used);
    return out;
}

int64_t arrival_us(int number)
{
    return 1000000 + 100000 * static_cast<int64_t>(number);
}

void begin_stream(Recording &recording)
{
    recording.put(ALE_CHUNK_SENT, 900000, "QT\n");
    recording.put(ALE_CHUNK_RECEIVED, 901000, "QT\n00P\n\n");
    recording.put(ALE_CHUNK_SENT, 950000, std::string(stream_echo) + "\n");
    recording.put(ALE_CHUNK_RECEIVED, 960000, std::string(stream_echo) + "\n00P\n\n");
}

TEST(Scip, ScansComeFromTheReceivedBytes)
{
    Recording recording;
    begin_stream(recording);
    for (int k = 0; k < 5; k++) {
        const std::string bytes = frame(k, 1000 + k);
        recording.put(ALE_CHUNK_RECEIVED, arrival_us(k), bytes.substr(0, 700));
        recording.put(ALE_CHUNK_RECEIVED, arrival_us(k) + 1000, bytes.substr(700));
    }
    const auto log = read_bytes(recording.bytes());
    const auto scans = log.scans();
    ASSERT_EQ(scans.size(), 5U);
    for (int k = 0; k < 5; k++) {
        const ale_scan_t &scan = scans[static_cast<size_t>(k)];
        EXPECT_EQ(scan.beams, beams);
        EXPECT_EQ(scan.range_um[300], (1000 + k) * 1000);
        EXPECT_EQ(ale_scan_bearing(&scan, 340), 0U);
        EXPECT_EQ(scan.stamp_us - scans[0].stamp_us, k * 100000);
    }
    EXPECT_TRUE(log.info.raw_device);
    EXPECT_STREQ(log.info.format, ".scip recording");
}

TEST(Scip, SeveralFramesInOneChunkAllCount)
{
    Recording recording;
    begin_stream(recording);
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(3), frame(0, 1000) + frame(1, 1100) + frame(2, 1200));
    EXPECT_EQ(read_bytes(recording.bytes()).scans().size(), 3U);
}

TEST(Scip, ADamagedScanIsALostOne)
{
    Recording recording;
    begin_stream(recording);
    for (int k = 0; k < 4; k++) {
        std::string bytes = frame(k, 1000);
        if (k == 2) {
            bytes[500] ^= 1;
        }
        recording.put(ALE_CHUNK_RECEIVED, arrival_us(k), bytes);
    }
    const auto log = read_bytes(recording.bytes());
    ASSERT_EQ(log.events.size(), 4U);
    EXPECT_EQ(log.events[2].kind, ALE_LOG_SCAN_LOST);
    EXPECT_NEAR(static_cast<double>(log.events[2].stamp_us - log.events[1].stamp_us), 100000, 2000);
    EXPECT_EQ(log.events[3].kind, ALE_LOG_SCAN);
}

TEST(Scip, ScansMissingByTheirStampsAreLostOnesUnlessTheStreamWasInterrupted)
{
    for (const bool interrupted : {false, true}) {
        Recording recording;
        begin_stream(recording);
        for (int k = 0; k < 25; k++) {
            if (k < 20 || k > 22) {
                recording.put(ALE_CHUNK_RECEIVED, arrival_us(k), frame(k, 1000));
            }
            if (k == 22 && interrupted) {
                recording.put(ALE_CHUNK_SENT, arrival_us(k), "\nQT\n");
            }
        }
        const auto log = read_bytes(recording.bytes());
        EXPECT_EQ(log.scans().size(), 22U);
        EXPECT_EQ(log.events.size(), interrupted ? 22U : 25U);
    }
}

TEST(Scip, ARecordingThatBeginsInMidStreamIsFollowed)
{
    Recording recording;
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(0), frame(0, 1000).substr(900) + frame(1, 1000));
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(2), frame(2, 1000));
    EXPECT_EQ(read_bytes(recording.bytes()).scans().size(), 2U);
}

TEST(Scip, OdometryCommandsAndConfigurationComeInOrder)
{
    Recording recording;
    recording.put(ALE_CHUNK_CONFIG, 1, "[sensor]\nx = 0.145\n");
    begin_stream(recording);
    const ale_odometry_t sample = {990000, {-5, 7, 1U << 31U}};
    EXPECT_EQ(ale_recording_odometry(recording.file(), 995000, &sample), 0);
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(0), frame(0, 1000));
    recording.put(ALE_CHUNK_COMMAND, 1200000, "reset");
    const auto log = read_bytes(recording.bytes());
    ASSERT_EQ(log.events.size(), 4U);
    EXPECT_EQ(log.events[0].kind, ALE_LOG_CONFIG);
    EXPECT_EQ(log.texts[0], "[sensor]\nx = 0.145\n");
    EXPECT_EQ(log.events[1].kind, ALE_LOG_ODOMETRY);
    EXPECT_EQ(log.events[1].odometry.pose.y_um, 7);
    EXPECT_EQ(log.events[1].odometry.pose.theta_bam, 1U << 31U);
    EXPECT_EQ(log.events[1].stamp_us, 990000);
    EXPECT_EQ(log.events[2].kind, ALE_LOG_SCAN);
    EXPECT_EQ(log.texts[3], "reset");
}

TEST(Scip, DamageInTheFileCostsItsChunkOnly)
{
    Recording recording;
    begin_stream(recording);
    for (int k = 0; k < 6; k++) {
        recording.put(ALE_CHUNK_RECEIVED, arrival_us(k), frame(k, 1000));
    }
    std::string bytes = recording.bytes();
    bytes[bytes.size() - 6000] ^= 0x10;
    const auto log = read_bytes(bytes);
    EXPECT_EQ(log.scans().size(), 5U);
    EXPECT_EQ(log.statistics.bad_chunks, 1U);
    const auto cut = read_bytes(bytes.substr(0, bytes.size() - 100));
    EXPECT_EQ(cut.scans().size(), 4U);
    EXPECT_EQ(cut.statistics.bad_chunks, 2U);
}

TEST(Scip, StampsThatNoClockHasCostTheirChunk)
{
    Recording recording;
    begin_stream(recording);
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(0), frame(0, 1000));
    recording.put(ALE_CHUNK_RECEIVED, INT64_MIN, frame(1, 1000));
    const ale_odometry_t sample = {INT64_MAX, {0, 0, 0}};
    EXPECT_EQ(ale_recording_odometry(recording.file(), arrival_us(1), &sample), 0);
    recording.put(ALE_CHUNK_RECEIVED, arrival_us(2), frame(2, 1000));
    const auto log = read_bytes(recording.bytes());
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_TRUE(log.odometry().empty());
    EXPECT_EQ(log.statistics.times_beyond, 2U);
}

} // namespace
