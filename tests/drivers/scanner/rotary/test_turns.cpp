// drivers/scanner/rotary: from points to turns.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include "base/trig.h"
#include "scanner/rotary/turns.h"
}

namespace
{

constexpr double turn = 4294967296.0;

// A head that turns clockwise in a round room, and packets of twelve points of it.
class Turns : public testing::Test
{
  protected:
    struct Out {
        bool lost;
        ale_scan_t scan;
    };
    std::unique_ptr<ale_turns_t> turns = std::make_unique<ale_turns_t>();
    std::vector<Out> out;
    double turns_a_second = 10;
    double points_a_second = 4500;
    double jitter = 0; // of a bearing, parts of a turn
    int64_t point = 0;

    void SetUp() override
    {
        begin(true, false);
    }
    void begin(bool clockwise, bool reversed)
    {
        ale_turns_init(turns.get(), clockwise, reversed);
        ale_turns_range(turns.get(), 20000, 12000000);
        ale_turns_begin(turns.get());
    }
    double time_us(int64_t k) const
    {
        return 7e6 + static_cast<double>(k) * 1e6 / points_a_second;
    }
    double phase(int64_t k) const
    {
        return (time_us(k) - 7e6) * 1e-6 * turns_a_second + 0.3 + (k % 2 == 0 ? jitter : -jitter);
    }
    // Range of a bearing: tells the bearing.
    static int32_t range_um(double phase)
    {
        return 1000000 + static_cast<int32_t>(1000000 * (phase - std::floor(phase)));
    }
    // The next so many packets, or as many that do not arrive.
    void go(int packets, bool arrive = true)
    {
        for (int k = 0; k < packets; k++, point += 12) {
            if (!arrive) {
                continue;
            }
            ale_rotary_packet_t packet{};
            packet.count = 12;
            for (int i = 0; i < 12; i++) {
                const double p = phase(point + i);
                const double bearing = (turns->clockwise ? -p : p) * turn;
                packet.points[i] = {static_cast<uint32_t>(static_cast<int64_t>(std::fmod(bearing, turn))),
                                    range_um(p)};
            }
            packet.sensor_us = std::llround(time_us(point + 11) / 1000) * 1000; // as an LD06 counts
            ale_turns_take(turns.get(), &packet, std::llround(time_us(point + 11)));
            fetch();
        }
    }
    void go_turns(double count)
    {
        go(static_cast<int>(count * points_a_second / turns_a_second / 12));
    }
    void fetch()
    {
        auto scan = std::make_unique<ale_scan_t>();
        for (ale_scanner_event_t kind;
             (kind = ale_turns_next(turns.get(), scan.get())) != ALE_SCANNER_IDLE;) {
            out.push_back({kind == ALE_SCANNER_SCAN_LOST, *scan});
        }
    }
    int lost() const
    {
        int count = 0;
        for (const Out &o : out) {
            count += o.lost;
        }
        return count;
    }
    // When the head looked straight ahead at the beginning of that turn.
    static double passed_ahead_us(const Out &o)
    {
        const double turned = static_cast<double>(0U - o.scan.first_bearing_bam) / turn;
        const double first_us = o.lost ? -50000 : ale_scan_beam_offset_us(&o.scan, 0) - turned * 100000;
        return static_cast<double>(o.scan.stamp_us) + first_us;
    }
    // Each valid beam has the range of its bearing, and the time at which the head looked there.
    void expect_right(const ale_scan_t &scan) const
    {
        int valid = 0;
        for (int k = 0; k < scan.beams; k++) {
            if (scan.flag[k] != ALE_BEAM_VALID) {
                continue;
            }
            valid++;
            const double bearing = ale_scan_bearing(&scan, k) / turn;
            const double ahead = turns->clockwise != turns->reversed ? 1 - bearing : bearing;
            const double seen = scan.range_um[k] / 1e6 - 1;
            EXPECT_LT(std::fabs(std::remainder(seen - ahead, 1)), 1.0 / scan.beams) << "beam " << k;
            const double at_us = static_cast<double>(scan.stamp_us + ale_scan_beam_offset_us(&scan, k));
            const double looked = (at_us - 7e6) * 1e-6 * turns_a_second + 0.3;
            EXPECT_LT(std::fabs(std::remainder(looked - ahead, 1)), 1.5 / scan.beams) << "beam " << k;
        }
        EXPECT_GT(valid, scan.beams / 2);
    }
};

TEST_F(Turns, EachTurnIsAScanWhateverTheCountOfItsPoints)
{
    for (const double speed : {5.0, 7.3, 10.0, 12.9}) {
        turns_a_second = speed;
        out.clear();
        point = 0;
        begin(true, false);
        go_turns(10.7);
        ASSERT_GE(out.size(), 9U) << speed;
        EXPECT_LE(out.size(), 10U) << speed;
        EXPECT_EQ(lost(), 0);
        EXPECT_NEAR(turns->period_us, 1e6 / speed, 300);
        EXPECT_NEAR(ale_turns_speed_mdeg_s(turns.get()), 360000 * speed, 3600 * speed);
        for (const Out &o : out) {
            expect_right(o.scan);
        }
        for (size_t k = 1; k < out.size(); k++) {
            EXPECT_NEAR(static_cast<double>(out[k].scan.stamp_us - out[k - 1].scan.stamp_us), 1e6 / speed,
                        600);
        }
    }
}

TEST_F(Turns, EitherSenseOfTurningAndEitherSideUp)
{
    for (const bool clockwise : {false, true}) {
        for (const bool reversed : {false, true}) {
            out.clear();
            point = 0;
            begin(clockwise, reversed);
            go_turns(5);
            ASSERT_GE(out.size(), 3U);
            expect_right(out.back().scan);
        }
    }
}

TEST_F(Turns, BearingsThatJitterMakeNoTurnOfTheirOwn)
{
    jitter = 0.004;
    go_turns(20.5);
    EXPECT_EQ(out.size(), 19U);
    EXPECT_EQ(lost(), 0);
}

TEST_F(Turns, ATurnWithAGapIsAScanThatSaysSo)
{
    go_turns(4.2);
    const size_t before = out.size();
    go(5, false); // 60 of 450 points
    go_turns(2);
    ASSERT_GT(out.size(), before + 1);
    EXPECT_EQ(lost(), 0);
    const ale_scan_t &gapped = out[before].scan;
    int unknown = 0;
    for (int k = 0; k < gapped.beams; k++) {
        unknown += gapped.flag[k] == ALE_BEAM_UNKNOWN;
    }
    EXPECT_NEAR(unknown, 60, 5);
    expect_right(gapped);
}

TEST_F(Turns, WhatWasMissedIsLostInOrder)
{
    go_turns(4.1);
    const size_t before = out.size();
    go(static_cast<int>(2.9 * 450 / 12), false);
    go_turns(2);
    EXPECT_EQ(lost(), 3);
    for (size_t k = before; k < before + 3; k++) {
        EXPECT_TRUE(out[k].lost) << k;
    }
    for (size_t k = 1; k < out.size(); k++) {
        EXPECT_NEAR(passed_ahead_us(out[k]) - passed_ahead_us(out[k - 1]), 100000, 1500) << k;
    }
}

TEST_F(Turns, AStreamThatBeginsAnewHasLostNothing)
{
    go_turns(4.1);
    point += 450 * 20;
    ale_turns_begin(turns.get());
    go_turns(3.5);
    EXPECT_EQ(lost(), 0);
    expect_right(out.back().scan);
}

TEST_F(Turns, AHeadThatStandsStillGivesNoScan)
{
    go_turns(3);
    const size_t before = out.size();
    const double stands = phase(point);
    ale_rotary_packet_t packet{};
    packet.count = 12;
    for (auto &p : packet.points) {
        p = {static_cast<uint32_t>(static_cast<int64_t>(-std::fmod(stands, 1) * turn)), 1000000};
    }
    for (int k = 0; k < 2000; k++, point += 12) {
        packet.sensor_us = std::llround(time_us(point + 11));
        ale_turns_take(turns.get(), &packet, packet.sensor_us);
        fetch();
    }
    EXPECT_EQ(out.size(), before);
    EXPECT_GT(turns->turn.count, unsigned{ALE_MAX_TURN_POINTS});
}

} // namespace
