// drivers/scanner/rplidar: descriptors, answers and the three codings of measurements, intact and not.
#include <random>

#include <gtest/gtest.h>

#include "drivers/scanner/rplidar/rplidar_bytes.hpp"

extern "C" {
#include "scanner/rplidar/rplidar_parse.h"
}

namespace
{

using namespace ale_test;

struct Read {
    std::vector<ale_rotary_point_t> points;
    std::vector<int64_t> packet_us;
    std::vector<std::string> answers;
    uint32_t damaged = 0;
    uint32_t garbage = 0;
};

Read read(const std::string &bytes, size_t piece = SIZE_MAX, int32_t point_ns = 250000)
{
    ale_rplidar_parser_t parser{};
    parser.point_ns = point_ns;
    Read out;
    for (size_t at = 0; at < bytes.size();) {
        const size_t count = std::min(piece, bytes.size() - at);
        ale_rotary_packet_t packet{};
        const uint32_t used = ale_rplidar_parse(&parser, reinterpret_cast<const uint8_t *>(bytes.data()) + at,
                                                static_cast<uint32_t>(count), &packet);
        EXPECT_GT(used, 0U);
        at += used;
        out.garbage += packet.garbage;
        out.damaged += packet.kind == ALE_PACKET_DAMAGED;
        if (packet.kind == ALE_PACKET_POINTS) {
            out.points.insert(out.points.end(), packet.points, packet.points + packet.count);
            out.packet_us.push_back(packet.sensor_us);
        } else if (packet.kind == ALE_PACKET_ANSWER) {
            out.answers.emplace_back(parser.answer, parser.answer + parser.answer_bytes);
        }
    }
    return out;
}

double clockwise(uint32_t bearing_bam)
{
    return static_cast<double>(0U - bearing_bam) * 360 / 4294967296.0;
}

const std::string standard = descriptor(5, 0x81, true);
const std::string express = descriptor(84, 0x82, true);
const std::string dense = descriptor(84, 0x85, true);

std::string nodes(int count)
{
    std::string out;
    for (int k = 0; k < count; k++) {
        out += node(k * 0.9, 1000 + k, k % 400 == 0);
    }
    return out;
}

TEST(RplidarParse, AnswersAreReadBehindAnything)
{
    const Read got =
        read("RP LIDAR System.\r\n\xa5" + answer(0x06, std::string("\0\1\2", 3)) + answer(0x15, "abcd"));
    EXPECT_EQ(got.answers, (std::vector<std::string>{std::string("\0\1\2", 3), "abcd"}));
    EXPECT_EQ(got.garbage, 19U);
}

TEST(RplidarParse, AnAnswerLongerThanAnyIsNone)
{
    EXPECT_TRUE(read(descriptor(65, 0x20, false) + std::string(65, 'x')).answers.empty());
    EXPECT_EQ(read(descriptor(0x3fffffff, 0x20, false) + answer(0x15, "abcd")).answers.size(), 1U);
}

TEST(RplidarParse, NodesOfTheStandardScan)
{
    const Read got = read(standard + nodes(80));
    ASSERT_EQ(got.points.size(), 80U);
    for (size_t k = 0; k < 80; k++) {
        EXPECT_NEAR(clockwise(got.points[k].bearing_bam), static_cast<double>(k) * 0.9, 0.01);
        EXPECT_EQ(got.points[k].range_um, 1000000 + static_cast<int>(k) * 1000);
    }
    EXPECT_EQ(got.packet_us[3] - got.packet_us[1], 2 * 8 * 250);
}

TEST(RplidarParse, PointsOfACapsuleEndWhereTheNextBegins)
{
    std::vector<unsigned> mm(32);
    for (unsigned k = 0; k < 32; k++) {
        mm[k] = 1000 + 10 * k;
    }
    const Read got =
        read(express + express_capsule(345.6, true, mm, 19) + express_capsule(14.4, false, mm, 0));
    ASSERT_EQ(got.points.size(), 32U);
    for (unsigned k = 0; k < 32; k++) {
        const double at = std::fmod(345.6 + 0.9 * k - 19 / 8.0 + 360, 360);
        EXPECT_NEAR(std::remainder(clockwise(got.points[k].bearing_bam) - at, 360), 0, 0.02) << k;
        EXPECT_EQ(got.points[k].range_um, static_cast<int>(1000 + 10 * k) * 1000);
    }
}

TEST(RplidarParse, PointsOfADenseCapsule)
{
    std::vector<unsigned> mm(40, 29000);
    mm[39] = 0;
    const Read got =
        read(dense + dense_capsule(10, true, mm) + dense_capsule(14.5, false, mm), SIZE_MAX, 31250);
    ASSERT_EQ(got.points.size(), 40U);
    EXPECT_NEAR(clockwise(got.points[0].bearing_bam), 10, 0.01);
    EXPECT_NEAR(clockwise(got.points[39].bearing_bam), 10 + 39 * 4.5 / 40, 0.01);
    EXPECT_EQ(got.points[0].range_um, 29000000);
    EXPECT_EQ(got.points[39].range_um, 0);
}

TEST(RplidarParse, ACapsuleThatBeginsAnewEndsNoOther)
{
    const std::vector<unsigned> mm(40, 1000);
    EXPECT_TRUE(read(dense + dense_capsule(10, true, mm) + dense_capsule(14.5, true, mm)).points.empty());
}

TEST(RplidarParse, OfAFlippedBitTwoCapsulesAreLostAndTheClockGoesOn)
{
    const std::vector<unsigned> mm(32, 1000);
    std::string stream;
    for (int k = 0; k < 6; k++) {
        stream += express_capsule(28.8 * k, k == 0, mm, 0);
    }
    for (size_t bit = 2 * 84 * 8; bit < 3 * 84 * 8; bit++) {
        std::string bad = stream;
        bad[bit / 8] = static_cast<char>(static_cast<unsigned char>(bad[bit / 8]) ^ 1U << bit % 8);
        const Read got = read(express + bad);
        EXPECT_EQ(got.points.size(), 3U * 32) << "bit " << bit;
        EXPECT_EQ(got.damaged, 1U) << "bit " << bit;
        EXPECT_EQ(got.packet_us.back() - got.packet_us.front(), 4 * 32 * 250) << "bit " << bit;
    }
}

TEST(RplidarParse, NodesComeIntoStepAgain)
{
    for (const size_t cut : {1U, 2U, 3U, 4U}) {
        std::string bytes = nodes(400);
        bytes.erase(803, cut);
        const Read got = read(standard + bytes);
        EXPECT_GT(got.points.size(), 380U) << cut;
        EXPECT_LT(got.points.size(), 400U) << cut;
        size_t wrong = 0;
        for (const ale_rotary_point_t &point : got.points) {
            const double expected = 1000 + clockwise(point.bearing_bam) / 0.9;
            wrong += std::fabs(point.range_um / 1000.0 - expected) > 1;
        }
        EXPECT_LE(wrong, 8U) << cut;
    }
}

TEST(RplidarParse, AnyBytesInAnyPiecesGiveTheSame)
{
    std::mt19937 random(1);
    for (int run = 0; run < 300; run++) {
        const std::string starts[] = {standard, express, dense, ""};
        std::string bytes = starts[random() % 4] + nodes(50);
        const std::vector<unsigned> mm(40, 1000);
        for (int k = 0; k < 6; k++) {
            bytes +=
                k % 2 == 0 ? express_capsule(20.0 * k, false, mm, 3) : dense_capsule(20.0 * k, false, mm);
        }
        for (int k = 0; k < 5; k++) {
            bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        const Read whole = read(bytes);
        for (const size_t piece : {size_t{1}, size_t{1 + random() % 50}}) {
            const Read pieces = read(bytes, piece);
            EXPECT_EQ(whole.packet_us, pieces.packet_us);
            EXPECT_EQ(whole.answers, pieces.answers);
            EXPECT_EQ(whole.damaged, pieces.damaged);
            EXPECT_EQ(whole.garbage, pieces.garbage);
            EXPECT_LE(whole.garbage, bytes.size());
        }
    }
}

} // namespace
