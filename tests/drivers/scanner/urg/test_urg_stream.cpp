#include <cstdint>

#include <gtest/gtest.h>

extern "C" {
#include "scanner/urg/urg_stream.h"
}

namespace
{

class Stream : public testing::Test
{
  protected:
    Stream()
    {
        ale_urg_stream_init(&stream, false);
        const ale_scip_request_t request{};
        ale_urg_stream_begin(&stream, &request);
    }
    /* How many of so many damaged frames, at such a distance, come out as lost scans. */
    int lost_of(int frames, int64_t distance_us)
    {
        int lost = 0;
        for (int k = 0; k < frames; k++) {
            now_us += distance_us;
            ale_scip_event_t event{};
            event.kind = ALE_SCIP_LOST;
            event.loss = ALE_SCIP_CUT;
            event.first_us = now_us;
            ale_urg_stream_take(&stream, &event);
            while (ale_urg_stream_next(&stream, &scan) == ALE_SCANNER_SCAN_LOST) {
                lost++;
            }
        }
        return lost;
    }

    ale_urg_stream_t stream{};
    ale_scan_t scan{};
    int64_t now_us = 5000000;
};

TEST_F(Stream, NoStampsMakeATurnLongerThanASensorMaySay)
{
    ale_urg_identity_t identity;
    ale_urg_identity_init(&identity);
    identity.geometry.rpm = 1;
    ale_urg_stream_describe(&stream, &identity.geometry, &identity.played);
    for (int k = 0; k < 100; k++) {
        now_us += 60003000;
        ale_scip_event_t event{};
        event.kind = ALE_SCIP_SCAN;
        event.stamp_known = true;
        event.stamp_ms = static_cast<uint32_t>(now_us / 1000 & 0xffffff);
        event.first_us = now_us;
        ASSERT_EQ(ale_urg_stream_take(&stream, &event), ALE_FRAME_SCAN);
        while (ale_urg_stream_next(&stream, &scan) != ALE_SCANNER_IDLE) {
        }
    }
    EXPECT_EQ(stream.regular, 3);
    EXPECT_EQ(stream.period_us, 60000000);
}

TEST_F(Stream, DamagedFramesOfAScannerAreAllLostScans)
{
    EXPECT_EQ(lost_of(1000, 100000), 1000);
    EXPECT_EQ(lost_of(20, 10), 20) << "in one go, where the line was held up";
    EXPECT_EQ(stream.losses_too_fast, 0U);
}

TEST_F(Stream, BeginningsOfFramesAtFullSpeedAreNoMoreScansThanAScannerMakes)
{
    const int lost = lost_of(120000, 100); /* 12 s */
    EXPECT_GE(lost, 120);
    EXPECT_LE(lost, 120 + 34);
    EXPECT_EQ(stream.losses_too_fast, 120000U - static_cast<unsigned>(lost));
    now_us += 5000000;
    EXPECT_EQ(lost_of(10, 100000), 10) << "afterwards all is as before";
}

} // namespace
