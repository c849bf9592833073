// A log through the simulated device and the driver's own parser: each scan comes out as it lies in the log.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

#include "files.hpp"
#include "lab/sim/device/scip_device.h"
#include "lab/sim/log_source.h"

extern "C" {
#include "scanner/urg/identity.h"
#include "scanner/urg/urg_stream.h"
}

namespace
{

constexpr int64_t utime_zero_us = 1700000000000000;
constexpr int64_t play_start_us = 1234567;

// A driver without a port: what it is told, and the scans that it makes of it.
class Driver
{
  public:
    std::vector<ale_scan_t> scans;

    Driver()
    {
        ale_scip_parser_init(&parser_);
        ale_urg_identity_init(&identity_);
        ale_urg_stream_init(&stream_, false);
    }
    void hear(const std::string &bytes, int64_t now_us)
    {
        for (size_t at = 0; at < bytes.size();) {
            ale_scip_event_t event;
            at += ale_scip_parse(&parser_, reinterpret_cast<const uint8_t *>(bytes.data()) + at,
                                 bytes.size() - at, utime_zero_us + now_us, &event);
            take(event);
        }
    }
    std::string request()
    {
        ale_scip_request_t request = {};
        request.first_step = static_cast<uint16_t>(identity_.geometry.first_step);
        request.last_step = static_cast<uint16_t>(identity_.geometry.last_step);
        request.cluster = 1;
        request.characters = 3;
        request.stream = true;
        request.protocol = 2;
        ale_urg_stream_describe(&stream_, &identity_.geometry, &identity_.played);
        ale_urg_stream_begin(&stream_, &request);
        char text[ALE_SCIP_REQUEST_TEXT];
        ale_scip_request_format(&request, text);
        return std::string(text) + "\n";
    }

  private:
    void take(const ale_scip_event_t &event)
    {
        if (event.kind == ALE_SCIP_LINE_READ) {
            ale_urg_identity_line(&identity_, event.text, event.sum_right);
        } else if (event.kind == ALE_SCIP_SCAN || event.kind == ALE_SCIP_LOST) {
            EXPECT_EQ(ale_urg_stream_take(&stream_, &event), ALE_FRAME_SCAN);
            auto scan = std::make_unique<ale_scan_t>();
            while (ale_urg_stream_next(&stream_, scan.get()) == ALE_SCANNER_SCAN) {
                scans.push_back(*scan);
            }
        }
    }

    ale_scip_parser_t parser_;
    ale_urg_identity_t identity_;
    ale_urg_stream_t stream_;
};

std::vector<ale_scan_t> over_the_line(const std::string &log)
{
    sim::LogSource source(log, true);
    sim::ScipDevice::Options options;
    options.utime_zero_us = utime_zero_us;
    sim::ScipDevice device(source.scanner(), options);
    Driver driver;
    const auto tell = [&](const std::vector<sim::Reply> &replies, int64_t now_us) {
        for (const sim::Reply &reply : replies) {
            driver.hear(reply.bytes, now_us);
        }
    };
    device.receive("PP\n", 1000);
    tell(device.answer(1000), 1000);
    device.receive(driver.request(), 2000);
    tell(device.answer(2000), 2000);
    while (const auto due_us = source.due_us()) {
        const sim::Event event = source.next();
        if (const auto *turn = std::get_if<sim::Turn>(&event)) {
            tell(device.turn(*turn, play_start_us + turn->start_us), play_start_us + *due_us);
        }
    }
    return driver.scans;
}

std::vector<ale_scan_t> in_the_log(const std::string &path)
{
    std::vector<ale_scan_t> scans;
    ale::LogReader log(path);
    const auto event = std::make_unique<ale_log_event_t>();
    while (log.next(*event)) {
        if (event->kind == ALE_LOG_SCAN) {
            scans.push_back(event->scan);
        }
    }
    return scans;
}

void expect_alike(const ale_scan_t &played, const ale_scan_t &logged)
{
    EXPECT_EQ(played.stamp_beam, logged.stamp_beam);
    EXPECT_EQ(played.beam_time_ns, logged.beam_time_ns);
    EXPECT_EQ(played.first_bearing_bam, logged.first_bearing_bam);
    EXPECT_EQ(played.step_bam, logged.step_bam);
    ASSERT_EQ(played.beams, logged.beams);
    for (int k = 0; k < logged.beams; k++) {
        EXPECT_EQ(played.range_um[k], logged.range_um[k]) << k;
        EXPECT_EQ(played.flag[k], logged.flag[k]) << k;
    }
}

void expect_played_as_logged(const std::string &path)
{
    const auto played = over_the_line(path);
    const auto logged = in_the_log(path);
    ASSERT_EQ(played.size(), logged.size());
    for (size_t k = 0; k < logged.size(); k++) {
        expect_alike(played[k], logged[k]);
        EXPECT_EQ(played[k].stamp_us - played[0].stamp_us, logged[k].stamp_us - logged[0].stamp_us) << k;
    }
}

class LogOnTheLine : public testing::Test
{
  protected:
    const files::TemporaryFolder folder;
    const std::string path = folder / "played.log";
    /* Uneven, sparse, backward. */
    const std::vector<double> stamps = {10,   10.098765, 10.103, 12.5,      11.9000005,
                                        31.4, 31.499999, 31.6,   31.800001, 31.9};
};

// What follows the ranges of a ROBOTLASER1 line: a robot that stands, and the stamp.
std::string at_origin(double t)
{
    char tail[100];
    std::snprintf(tail, sizeof tail, " 0 0 0 0 0 0 0 0 0 0 0 0 %.6f host %.6f\n", t, t);
    return tail;
}

TEST_F(LogOnTheLine, scans_taken_at_once_by_another_scanner)
{
    std::ofstream out(path);
    for (const double t : stamps) {
        out << "FLASER 180";
        for (int k = 0; k < 180; k++) {
            out << (k % 50 == 0   ? " 81.83"
                    : k % 50 == 1 ? " 0.00"
                                  : " " + std::to_string(k % 10 + 1) + ".273");
        }
        char tail[100];
        std::snprintf(tail, sizeof tail, " 0 0 0 0 0 0 %.6f host %.6f\n", t, t);
        out << tail;
    }
    out.close();
    expect_played_as_logged(path);
}

TEST_F(LogOnTheLine, a_scanner_between_whole_steps_that_turns_clockwise)
{
    std::ofstream out(path);
    for (const double t : stamps) {
        out << "ROBOTLASER1 0 1.003 2.0 -0.0174533 20 0.01 0 4 1.5 2.5 20.0 3.5" << at_origin(t);
    }
    out.close();
    expect_played_as_logged(path);
}

TEST_F(LogOnTheLine, a_urg_that_sweeps)
{
    std::ofstream out(path);
    out << "# beam_time_us 97.656 stamp_beam 1\n";
    for (const double t : stamps) {
        out << "ROBOTLASER1 4 -0.006135923 0.012271846 0.006135923 5.6 0.01 0 3 1.000 0.000 1.234"
            << at_origin(t);
    }
    out.close();
    expect_played_as_logged(path);
}

} // namespace
