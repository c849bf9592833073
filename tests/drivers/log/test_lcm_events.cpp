/* The container is written by liblcm itself; messages by the project's own encoder. */
#include <memory>

#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include "files.hpp"
#include "log_text.hpp"

extern "C" {
#include "lcm/convert.h"
}

using ale_test::gzip;
using ale_test::read_bytes;

namespace
{

class EventLog
{
  public:
    EventLog()
    {
        log_ = lcm_eventlog_create(path_.c_str(), "w");
    }
    void put(const std::string &channel, const std::string &data, int64_t received_us = 5)
    {
        std::string name = channel;
        std::string copy = data;
        lcm_eventlog_event_t event{};
        event.timestamp = received_us;
        event.channel = name.data();
        event.channellen = static_cast<int32_t>(name.size());
        event.data = copy.data();
        event.datalen = static_cast<int32_t>(copy.size());
        ASSERT_EQ(lcm_eventlog_write_event(log_, &event), 0);
    }
    std::string bytes()
    {
        lcm_eventlog_destroy(log_);
        return files::content(path_);
    }

  private:
    const files::TemporaryFolder folder_;
    const std::string path_ = folder_ / "events";
    lcm_eventlog_t *log_;
};

ale_scan_t urg_scan(int64_t stamp_us, uint16_t beams = 682)
{
    ale_scan_t scan{};
    scan.stamp_us = stamp_us;
    scan.stamp_beam = -44;
    scan.beam_time_ns = 97656;
    scan.step_bam = 1 << 22;
    scan.first_bearing_bam = 0U - (340U << 22U);
    scan.range_min_um = 20000;
    scan.range_max_um = 5600000;
    scan.beams = beams;
    for (uint16_t k = 0; k < beams; k++) {
        ale_scan_set_urg(&scan, k, k % 17 == 0 ? k % 20 : 1000 + k);
    }
    return scan;
}

std::string encoded(const ale_scan_t &scan, const ale_pose_t &sensor)
{
    lcmtypes_ale_scan_t message;
    const auto buffer = std::make_unique<ale_scan_buffer_t>();
    ale_convert_scan(&scan, scan.stamp_us, 0, sensor, buffer.get(), &message);
    std::string out(static_cast<size_t>(lcmtypes_ale_scan_t_encoded_size(&message)), '\0');
    lcmtypes_ale_scan_t_encode(out.data(), 0, static_cast<int>(out.size()), &message);
    return out;
}

std::string encoded(const ale_odometry_t &odometry)
{
    lcmtypes_ale_odometry_t message;
    ale_convert_odometry(&odometry, &message);
    std::string out(static_cast<size_t>(lcmtypes_ale_odometry_t_encoded_size(&message)), '\0');
    lcmtypes_ale_odometry_t_encode(out.data(), 0, static_cast<int>(out.size()), &message);
    return out;
}

TEST(LcmEvents, AScanComesBackAsItWasSent)
{
    const ale_scan_t sent = urg_scan(1700000000123456);
    EventLog log;
    log.put("ALE_POSE", "something else");
    log.put("ALE_SCAN", encoded(sent, {145000, -20000, 1U << 30U}));
    const auto read = read_bytes(log.bytes());
    ASSERT_EQ(read.scans().size(), 1U);
    const ale_scan_t scan = read.scans()[0];
    EXPECT_EQ(scan.stamp_us, sent.stamp_us);
    EXPECT_EQ(scan.stamp_beam, sent.stamp_beam);
    EXPECT_EQ(scan.beam_time_ns, sent.beam_time_ns);
    EXPECT_EQ(scan.step_bam, sent.step_bam);
    EXPECT_EQ(scan.first_bearing_bam, sent.first_bearing_bam);
    EXPECT_EQ(scan.range_max_um, sent.range_max_um);
    ASSERT_EQ(scan.beams, sent.beams);
    for (int k = 0; k < scan.beams; k++) {
        EXPECT_EQ(scan.range_um[k], sent.range_um[k]) << k;
        EXPECT_EQ(scan.flag[k], sent.flag[k]) << k;
        EXPECT_EQ(scan.code[k], sent.code[k]) << k;
    }
    EXPECT_TRUE(read.info.has_sensor);
    EXPECT_NEAR(read.info.sensor.x_um, 145000, 1);
    EXPECT_NEAR(read.info.sensor.y_um, -20000, 1);
    EXPECT_TRUE(read.info.urg_noise);
    EXPECT_FALSE(read.info.has_odometry);
}

TEST(LcmEvents, OdometryComesWithTheTimeInItsMessage)
{
    EventLog log;
    log.put("ALE_ODOMETRY", encoded(ale_odometry_t{900000, {1000000, 0, 0}}), 77);
    log.put("ALE_SCAN", encoded(urg_scan(1000000), {}), 78);
    log.put("ALE_ODOMETRY", encoded(ale_odometry_t{1000000, {1000000, 0, 0}}), 79);
    const auto read = read_bytes(gzip(log.bytes()));
    ASSERT_EQ(read.odometry().size(), 2U) << "a robot at rest has odometry too";
    EXPECT_EQ(read.odometry()[0].stamp_us, 900000);
    EXPECT_EQ(read.odometry()[0].pose.x_um, 1000000);
    EXPECT_TRUE(read.info.has_odometry);
}

TEST(LcmEvents, DamageIsSkippedToTheNextEvent)
{
    EventLog log;
    for (int k = 1; k <= 5; k++) {
        log.put("ALE_SCAN", encoded(urg_scan(k * 100000), {}));
    }
    std::string bytes = log.bytes();
    const size_t event = bytes.size() / 5;
    std::string flipped = bytes;
    flipped[2 * event] = 'x'; /* the sync word of the third */
    const auto read = read_bytes(flipped);
    EXPECT_EQ(read.scans().size(), 4U);
    EXPECT_EQ(read.statistics.bad_chunks, 1U);
    const auto cut = read_bytes(bytes.substr(0, bytes.size() - 10));
    EXPECT_EQ(cut.scans().size(), 4U);
    EXPECT_EQ(cut.statistics.bad_chunks, 1U);
}

TEST(LcmEvents, AMessageThatClaimsMoreThanItHoldsIsRefused)
{
    const std::string good = encoded(urg_scan(100000), {});
    for (const size_t at : {size_t{56}, size_t{56 + 4 + 2 * 682 + 2}}) {
        for (const char high : {'\x7f', '\xff', '\x00'}) {
            std::string forged = good;
            forged[at] = high;
            forged[at + 1] = '\x7f';
            EventLog log;
            log.put("ALE_SCAN", good);
            log.put("ALE_SCAN", forged);
            const auto read = read_bytes(log.bytes());
            EXPECT_EQ(read.scans().size(), 1U);
            EXPECT_EQ(read.statistics.bad_chunks, 1U);
        }
    }
}

TEST(LcmEvents, NumbersThatCannotBeAreRefused)
{
    ale_scan_t scan = urg_scan(100000);
    std::string bytes = encoded(scan, {});
    for (int field = 0; field < 8; field++) {
        std::string forged = bytes;
        forged[24 + 4 * static_cast<size_t>(field)] = '\x7f';
        forged[25 + 4 * static_cast<size_t>(field)] = '\xc0'; /* a float that is not a number */
        EventLog log;
        log.put("ALE_SCAN", forged);
        EXPECT_EQ(read_bytes(log.bytes()).statistics.bad_chunks, 1U) << field;
    }
}

} // namespace
