// A recording played over the line: every scan comes out once, with the stamp and the beams it has in the
// log.
#include <gtest/gtest.h>

#include <string>
#include <vector>

extern "C" {
#include "base/trig.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/urg_stream.h"
}

namespace
{

constexpr int64_t zero_us = 5000000000;
constexpr int32_t degree_bam = 11930465;

ale_urg_played_t whole_scans()
{
    ale_urg_played_t played = {};
    played.silence_ms = 21000;
    played.zero_us = zero_us;
    played.tick_us = 1;
    played.origin_bam = -90 * degree_bam;
    played.step_bam = degree_bam;
    played.blind_before = 2;
    played.blind_from = 9;
    return played;
}

std::string text_of(const ale_urg_played_t &played)
{
    char text[ALE_URG_PLAYED_TEXT];
    ale_urg_played_format(&played, text);
    return text;
}

TEST(Played, what_is_said_of_a_recording_is_understood)
{
    const std::string text = text_of(whole_scans());
    ale_urg_played_t read = {};
    ASSERT_TRUE(ale_urg_played_parse(text.c_str(), &read));
    EXPECT_EQ(text_of(read), text);
    EXPECT_EQ(read.zero_us, zero_us);
    EXPECT_EQ(read.blind_from, 9);
}

TEST(Played, what_makes_no_sense_is_refused)
{
    ale_urg_played_t read = {};
    for (const char *text :
         {"", "1", "1,2,3,4,5,6,7,8", "1,2,3,4,5,6,7,8,9,10", "0,2,3,4,5,6,7,8,9", "1,2,0,4,5,6,7,8,9",
          "1,2,3,4,-5,6,7,8,9", "1,2,3,4,5,6,0,8,9", "a,2,3,4,5,6,7,8,9",
          "99999999999999999999,2,3,4,5,6,7,8,9", "1,2,3,4,5,6,7,8,9 "}) {
        EXPECT_FALSE(ale_urg_played_parse(text, &read)) << text;
        EXPECT_EQ(read.silence_ms, 0);
    }
}

TEST(Played, a_device_that_says_nothing_of_it_plays_none)
{
    ale_urg_identity_t identity;
    ale_urg_identity_init(&identity);
    ale_urg_identity_line(&identity, ("PLAY:" + text_of(whole_scans())).c_str(), true);
    EXPECT_EQ(identity.played.silence_ms, 21000);
    ale_urg_identity_line(&identity, "DMIN:20", true);
    EXPECT_EQ(identity.played.silence_ms, 0);
    EXPECT_EQ(identity.warnings, 0u);
    ale_urg_identity_line(&identity, "PLAY:what", true);
    EXPECT_EQ(identity.warnings, 1u);
}

TEST(Played, a_counter_that_came_round_is_followed)
{
    const ale_urg_played_t played = whole_scans();
    for (const int64_t after_us : {0LL, 16777215LL, 16777216LL, 918935000000LL}) {
        for (const int64_t late_us : {-900000LL, 0LL, 101000LL, 15000000LL}) {
            const auto stamp = static_cast<uint32_t>(after_us % (1 << 24));
            EXPECT_EQ(ale_urg_played_us(&played, stamp, zero_us + after_us + late_us), zero_us + after_us);
        }
    }
}

// A stream of scans of eleven beams, one a degree.
class PlayedStream : public testing::Test
{
  protected:
    ale_urg_stream_t stream{};
    ale_scip_request_t request{};
    std::vector<int32_t> values = std::vector<int32_t>(11, 1000);

    void SetUp() override
    {
        ale_urg_identity_t identity;
        ale_urg_identity_init(&identity);
        const ale_urg_played_t played = whole_scans();
        ale_urg_stream_init(&stream, false);
        ale_urg_stream_describe(&stream, &identity.geometry, &played);
        request.last_step = 10;
        request.cluster = 1;
        request.characters = 3;
        request.stream = true;
        request.protocol = 2;
        ale_urg_stream_begin(&stream, &request);
    }
    // The scan of that time of the recording comes late_us after it.
    ale_frame_t come(int64_t at_us, int64_t late_us = 101000, ale_scip_kind_t kind = ALE_SCIP_SCAN)
    {
        ale_scip_event_t event = {};
        event.kind = kind;
        event.request = request;
        event.stamp_known = true;
        event.stamp_ms = static_cast<uint32_t>(at_us) & 0xffffff;
        event.first_us = event.last_us = zero_us + at_us + late_us;
        event.values = values.data();
        event.value_count = static_cast<uint32_t>(values.size());
        return ale_urg_stream_take(&stream, &event);
    }
    // Stamps of what the stream hands out now; losses are negative.
    std::vector<int64_t> out(ale_scan_t &scan)
    {
        std::vector<int64_t> stamps;
        for (ale_scanner_event_t event = ale_urg_stream_next(&stream, &scan); event != ALE_SCANNER_IDLE;
             event = ale_urg_stream_next(&stream, &scan)) {
            stamps.push_back(event == ALE_SCANNER_SCAN ? scan.stamp_us - zero_us : -1);
        }
        return stamps;
    }
};

TEST_F(PlayedStream, stamps_are_those_of_the_recording_however_late_they_come)
{
    ale_scan_t scan = {};
    const std::vector<std::pair<int64_t, int64_t>> comings = {
        {0, 101000},       {100000, 3000000},  {200000, 101000},   {400000, 250000},   {3400001, 101000},
        {2900001, 800000}, {23900001, 101000}, {23900002, 101000}, {24100003, 5000000}};
    for (const auto &[at_us, late_us] : comings) {
        EXPECT_EQ(come(at_us, late_us), ALE_FRAME_SCAN);
        EXPECT_EQ(out(scan), std::vector<int64_t>{at_us});
    }
}

TEST_F(PlayedStream, a_frame_that_comes_twice_is_one_scan)
{
    ale_scan_t scan = {};
    EXPECT_EQ(come(100000), ALE_FRAME_SCAN);
    EXPECT_EQ(out(scan), std::vector<int64_t>{100000});
    EXPECT_EQ(come(100000), ALE_FRAME_REPEATED);
    EXPECT_EQ(come(200000, 101000, ALE_SCIP_LOST), ALE_FRAME_LOST);
    EXPECT_EQ(out(scan), std::vector<int64_t>{-1});
    EXPECT_EQ(scan.stamp_us, zero_us + 200000);
}

TEST_F(PlayedStream, beams_lie_where_the_recording_has_them)
{
    ale_scan_t scan = {};
    values[0] = values[3] = values[10] = 0;
    come(0);
    out(scan);
    EXPECT_EQ(scan.beam_time_ns, 0);
    EXPECT_EQ(scan.stamp_beam, 0);
    EXPECT_EQ(static_cast<int32_t>(scan.first_bearing_bam), -90 * degree_bam);
    EXPECT_EQ(scan.step_bam, degree_bam);
    EXPECT_EQ(scan.flag[0], ALE_BEAM_BLIND);
    EXPECT_EQ(scan.flag[1], ALE_BEAM_VALID);
    EXPECT_EQ(scan.flag[3], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(scan.flag[10], ALE_BEAM_BLIND);
}

TEST_F(PlayedStream, without_a_clock_of_messages_stamps_begin_where_the_first_scan_came)
{
    ale_scan_t scan = {};
    stream.played.zero_us = ALE_URG_PLAYED_ZERO_UNKNOWN;
    come(300000);
    const std::vector<int64_t> first = out(scan);
    come(1300000, 105000);
    EXPECT_EQ(first, std::vector<int64_t>{301000});
    EXPECT_EQ(out(scan), std::vector<int64_t>{1301000});
}

} // namespace
