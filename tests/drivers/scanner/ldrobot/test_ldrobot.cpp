// drivers/scanner/ldrobot: the packets of an LD06, intact and not.
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/scanner/ldrobot/ldrobot_packet.hpp"

extern "C" {
#include "scanner/ldrobot/ldrobot.h"
}

namespace
{

using ale_test::LdrobotPacket;

struct Read {
    std::vector<ale_rotary_packet_t> packets; // of points
    uint32_t damaged = 0;
    uint32_t garbage = 0;
};

Read read(const std::string &bytes, size_t piece = SIZE_MAX)
{
    ale_ldrobot_t state{};
    Read out;
    for (size_t at = 0; at < bytes.size();) {
        const size_t count = std::min(piece, bytes.size() - at);
        ale_rotary_packet_t packet{};
        const uint32_t used = ale_ldrobot_parse(&state, reinterpret_cast<const uint8_t *>(bytes.data()) + at,
                                                static_cast<uint32_t>(count), &packet);
        EXPECT_GT(used, 0U);
        EXPECT_LE(used, count);
        at += used;
        out.garbage += packet.garbage;
        out.damaged += packet.kind == ALE_PACKET_DAMAGED;
        if (packet.kind == ALE_PACKET_POINTS) {
            out.packets.push_back(packet);
        }
    }
    return out;
}

double clockwise_degrees(uint32_t bearing_bam)
{
    return static_cast<double>(0U - bearing_bam) * 360 / 4294967296.0;
}

void expect_same(const Read &a, const Read &b)
{
    ASSERT_EQ(a.packets.size(), b.packets.size());
    EXPECT_EQ(a.damaged, b.damaged);
    EXPECT_EQ(a.garbage, b.garbage);
    for (size_t k = 0; k < a.packets.size(); k++) {
        EXPECT_EQ(a.packets[k].sensor_us, b.packets[k].sensor_us);
        for (uint32_t i = 0; i < a.packets[k].count; i++) {
            EXPECT_EQ(a.packets[k].points[i].bearing_bam, b.packets[k].points[i].bearing_bam);
            EXPECT_EQ(a.packets[k].points[i].range_um, b.packets[k].points[i].range_um);
        }
    }
}

TEST(Ldrobot, ThePacketOfTheManualIsRead)
{
    const Read got = read(ale_test::packet_of_the_manual());
    ASSERT_EQ(got.packets.size(), 1U);
    const ale_rotary_packet_t &packet = got.packets[0];
    ASSERT_EQ(packet.count, 12U);
    EXPECT_EQ(packet.speed_mdeg_s, 2152000);
    EXPECT_EQ(packet.points[0].range_um, 224000);
    EXPECT_EQ(packet.points[11].range_um, 192000);
    EXPECT_NEAR(clockwise_degrees(packet.points[0].bearing_bam), 324.27, 1e-6);
    EXPECT_NEAR(clockwise_degrees(packet.points[11].bearing_bam), 334.70, 1e-6);
    EXPECT_NEAR(clockwise_degrees(packet.points[5].bearing_bam), 324.27 + 5 * 10.43 / 11, 1e-6);
    EXPECT_EQ(got.garbage, 0U);
}

TEST(Ldrobot, BearingsGoOnThroughStraightAhead)
{
    LdrobotPacket packet;
    packet.start = 35560;
    packet.end = 440;
    const Read got = read(packet.bytes());
    ASSERT_EQ(got.packets.size(), 1U);
    EXPECT_NEAR(clockwise_degrees(got.packets[0].points[5].bearing_bam), 359.6, 1e-6);
    EXPECT_NEAR(clockwise_degrees(got.packets[0].points[6].bearing_bam), 0.4, 1e-6);
}

TEST(Ldrobot, ItsClockGoesOnWhereTheStampBeginsAnew)
{
    LdrobotPacket packet;
    std::string bytes;
    for (const unsigned stamp_ms : {29995U, 29998U, 0U, 3U}) {
        packet.stamp_ms = stamp_ms;
        bytes += packet.bytes();
    }
    const Read got = read(bytes);
    ASSERT_EQ(got.packets.size(), 4U);
    EXPECT_EQ(got.packets[3].sensor_us - got.packets[0].sensor_us, 8000);
}

TEST(Ldrobot, OfEveryFlippedBitThatPacketAloneIsLost)
{
    const std::string good = ale_test::packet_of_the_manual();
    for (size_t bit = 0; bit < good.size() * 8; bit++) {
        std::string bad = good;
        bad[bit / 8] = static_cast<char>(static_cast<unsigned char>(bad[bit / 8]) ^ 1U << bit % 8);
        const Read got = read(good + bad + good);
        EXPECT_EQ(got.packets.size(), 2U) << "bit " << bit;
        EXPECT_EQ(got.garbage, good.size()) << "bit " << bit;
        EXPECT_EQ(got.damaged, bit < 16 ? 0U : 1U) << "bit " << bit;
    }
}

TEST(Ldrobot, APacketThatBeginsWithinADamagedOneIsRead)
{
    const std::string good = ale_test::packet_of_the_manual();
    for (size_t cut = 1; cut < good.size(); cut++) {
        EXPECT_EQ(read(good.substr(0, cut) + good).packets.size(), 1U) << "cut after " << cut;
        EXPECT_EQ(read(good.substr(0, cut) + good + good).packets.size(), 2U) << "cut after " << cut;
    }
    EXPECT_EQ(read("\x54" + good).packets.size(), 1U) << "its makers' own driver loses this one";
}

TEST(Ldrobot, WhatMakesNoSenseIsDamageThoughItsSumIsRight)
{
    LdrobotPacket beyond;
    beyond.start = 36000;
    LdrobotPacket wide;
    wide.end = 18000;
    EXPECT_EQ(read(beyond.bytes()).damaged, 1U);
    EXPECT_EQ(read(wide.bytes()).damaged, 1U);
}

TEST(Ldrobot, AnyBytesInAnyPiecesGiveTheSame)
{
    std::mt19937 random(1);
    for (int run = 0; run < 300; run++) {
        std::string bytes;
        while (bytes.size() < 600) {
            LdrobotPacket packet;
            packet.stamp_ms = static_cast<unsigned>(random() % 30000);
            std::string next = packet.bytes();
            switch (random() % 5) {
            case 0:
                next[random() % next.size()] = static_cast<char>(random());
                break;
            case 1:
                next.resize(random() % next.size());
                break;
            case 2:
                std::generate(next.begin(), next.end(), [&] { return "\x54\x2c"[random() % 2]; });
                break;
            default:
                break;
            }
            bytes += next;
        }
        const Read whole = read(bytes);
        expect_same(whole, read(bytes, 1));
        expect_same(whole, read(bytes, 1 + random() % 100));
        EXPECT_LE(whole.garbage + 47 * whole.packets.size(), bytes.size());
    }
}

} // namespace
