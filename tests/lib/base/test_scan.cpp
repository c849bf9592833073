// lib/base/scan.c: time of a beam, blind sectors, meaning of range values.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

extern "C" {
#include "base/scan.h"
#include "base/trig.h"
}

namespace
{

std::unique_ptr<ale_scan_t> urg()
{
    auto scan = std::make_unique<ale_scan_t>();
    scan->beams = 682;
    scan->step_bam = 1 << 22;
    scan->first_bearing_bam = static_cast<uint32_t>(-340 * (1 << 22));
    scan->range_min_um = 60000;
    scan->range_max_um = 5600000;
    scan->beam_time_ns = 97656;
    scan->stamp_beam = -44;
    return scan;
}

TEST(Scan, BeamTimesAreCountedFromTheStampedBeam)
{
    const auto scan = urg();
    EXPECT_EQ(ale_scan_beam_offset_us(scan.get(), -44), 0);
    EXPECT_EQ(ale_scan_beam_offset_us(scan.get(), 0), 4297);
    EXPECT_EQ(ale_scan_beam_offset_us(scan.get(), 681), 70801);
}

TEST(Scan, IsSparseWhereFewerThanThreeInFourEchoesHaveOneNextToThem)
{
    const auto scan = urg();
    EXPECT_FALSE(ale_scan_is_sparse(urg().get())) << "echoes everywhere";
    for (int missing = 1; missing <= 3; missing++) { // of eight beams: 6/7, 4/6, 2/5 have a next one
        for (int k = 0; k < scan->beams; k++) {
            scan->flag[k] = k % 2 == 1 && k % 8 < 2 * missing ? ALE_BEAM_NO_RETURN : ALE_BEAM_VALID;
        }
        EXPECT_EQ(ale_scan_is_sparse(scan.get()), missing > 1) << missing;
    }
    for (int k = 0; k < scan->beams; k++) {
        scan->flag[k] = ALE_BEAM_UNKNOWN;
    }
    EXPECT_FALSE(ale_scan_is_sparse(scan.get())) << "no echo at all";
}

TEST(Scan, AMissingEchoIsForgivenBetweenTwoOthersThatAreNear)
{
    const auto scan = urg();
    for (int k = 0; k < scan->beams; k++) {
        scan->flag[k] = ALE_BEAM_NO_RETURN;
    }
    for (const int k : {10, 12, 20, 29}) {
        scan->flag[k] = ALE_BEAM_VALID;
    }
    scan->flag[15] = ALE_BEAM_BLIND;
    ale_scan_forgive_missing(scan.get());
    for (int k = 0; k < scan->beams; k++) {
        const bool echo = k == 10 || k == 12 || k == 20 || k == 29;
        const int expected = echo                ? ALE_BEAM_VALID
                             : k == 15           ? ALE_BEAM_BLIND
                             : k > 10 && k <= 20 ? ALE_BEAM_UNKNOWN
                                                 : ALE_BEAM_NO_RETURN;
        EXPECT_EQ(scan->flag[k], expected) << k;
    }
}

TEST(Scan, BeforeTheFirstEchoNothingIsForgivenAndNothingElseTouched)
{
    const auto scan = urg();
    for (int32_t &range_um : scan->range_um) {
        range_um = 0x01010101; /* each byte as a NO_RETURN would be */
    }
    for (uint16_t k = 0; k < scan->beams; k++) {
        scan->flag[k] = k % 5 == 0 ? ALE_BEAM_VALID : ALE_BEAM_NO_RETURN;
    }
    scan->flag[0] = ALE_BEAM_VALID;
    ale_scan_forgive_missing(scan.get());
    for (const int32_t range_um : scan->range_um) {
        ASSERT_EQ(range_um, 0x01010101);
    }
}

TEST(Scan, ASweepOfEitherDirectionEndsNearItsStamp)
{
    const auto scan = urg();
    EXPECT_TRUE(ale_scan_is_sweep(scan.get()));
    scan->stamp_beam = 340000000;
    EXPECT_FALSE(ale_scan_is_sweep(scan.get()));
    scan->stamp_beam = INT32_MIN;
    scan->beam_time_ns = INT32_MAX;
    EXPECT_FALSE(ale_scan_is_sweep(scan.get()));
    scan->beam_time_ns = INT32_MIN;
    EXPECT_FALSE(ale_scan_is_sweep(scan.get()));
    scan->stamp_beam = 0;
    EXPECT_FALSE(ale_scan_is_sweep(scan.get()));
    scan->beam_time_ns = -97656;
    EXPECT_TRUE(ale_scan_is_sweep(scan.get()));
    scan->beam_time_ns = 0;
    EXPECT_TRUE(ale_scan_is_sweep(scan.get()));
}

TEST(Scan, ABlindSectorMayWrapAndBlindsNothingElse)
{
    const auto scan = urg();
    const ale_sector_t sector = {static_cast<uint32_t>(10 * (1 << 22)),
                                 static_cast<uint32_t>(-10 * (1 << 22))};
    ale_scan_mask(scan.get(), &sector, 1);
    for (int k = 0; k < 682; k++) {
        const bool ahead = k > 330 && k < 350;
        EXPECT_EQ(scan->flag[k] == ALE_BEAM_BLIND, !ahead) << k;
    }
}

TEST(Scan, BearingsMayRunClockwise)
{
    const auto scan = urg();
    scan->step_bam = -(1 << 22);
    EXPECT_EQ(ale_bam_diff(ale_scan_bearing(scan.get(), 3), ale_scan_bearing(scan.get(), 4)), 1 << 22);
}

TEST(Scan, RangesOutsideTheSensorsReachAreFlagged)
{
    const auto scan = urg();
    ale_scan_set_range(scan.get(), 0, 2000000);
    ale_scan_set_range(scan.get(), 1, 0);
    ale_scan_set_range(scan.get(), 2, 5600000);
    ale_scan_set_range(scan.get(), 3, 59999);
    ale_scan_set_range(scan.get(), 4, -5);
    EXPECT_EQ(scan->flag[0], ALE_BEAM_VALID);
    EXPECT_EQ(scan->range_um[0], 2000000);
    EXPECT_EQ(scan->flag[1], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(scan->flag[2], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(scan->flag[3], ALE_BEAM_TOO_NEAR);
    EXPECT_EQ(scan->flag[4], ALE_BEAM_NO_RETURN);
}

TEST(Scan, UrgCodesAreNotRanges)
{
    const auto scan = urg();
    for (int value = 0; value < 20; value++) {
        ale_scan_set_urg(scan.get(), 0, value);
        EXPECT_NE(scan->flag[0], ALE_BEAM_VALID) << value;
        EXPECT_EQ(scan->code[0], value);
    }
    ale_scan_set_urg(scan.get(), 0, 1234);
    EXPECT_EQ(scan->flag[0], ALE_BEAM_VALID);
    EXPECT_EQ(scan->range_um[0], 1234000);
    EXPECT_EQ(scan->code[0], 0);
}

} // namespace
