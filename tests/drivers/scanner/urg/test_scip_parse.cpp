#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "drivers/scanner/urg/scip_text.hpp"

using ale_test::frame;
using ale_test::parse;
using ale_test::parse_into;
using ale_test::Parsed;

namespace
{

class ScipParse : public testing::Test
{
  protected:
    ale_scip_parser_t parser{};
    void SetUp() override
    {
        ale_scip_parser_init(&parser);
    }
    const ale_scip_counters_t &counters() const
    {
        return *ale_scip_counters(&parser);
    }
};

std::vector<int32_t> ramp(size_t count, int32_t first = 0)
{
    std::vector<int32_t> values(count);
    for (size_t k = 0; k < count; k++) {
        values[k] = first + static_cast<int32_t>(k);
    }
    return values;
}

TEST_F(ScipParse, replies_without_lines_of_both_protocols)
{
    const struct {
        const char *bytes, *echo, *status;
        int protocol;
    } replies[] = {
        {"QT\n00P\n\n", "QT", "00", 2},
        {"BM\n02R\n\n", "BM", "02", 2},
        {"CR00\n03S\n\n", "CR00", "03", 2},
        {"QT\n0Ee\n\n", "QT", "0E", 2},
        {"MD0044072501000\n00P\n\n", "MD0044072501000", "00", 2},
        {"MD0044072501000\n0Bb\n\n", "MD0044072501000", "0B", 2},
        {"MD0044072501000\n51V\n\n", "MD0044072501000", "51", 2},
        {"GD0044072501\n10Q\n\n", "GD0044072501", "10", 2},
        {"TM0\n00P\n\n", "TM0", "00", 2},
        {"SCIP2.0\n0\n\n", "SCIP2.0", "0", 1},
        {"SCIP2.0\n0Ee\n\n", "SCIP2.0", "0E", 2},
        {"QT\nE\n\n", "QT", "E", 1},
        {"L1\n0\n\n", "L1", "0", 1},
        {"S1152000000000\n0\n\n", "S1152000000000", "0", 1},
        {"S11520000000000\n\n", "S1152000000000", "0", 1}, // status behind the echo, as the document has it
        {"VV;abc_+@. 12\n0Aa\n\n", "VV;abc_+@. 12", "0A", 2},
    };
    for (const auto &reply : replies) {
        const std::vector<Parsed> events = parse_into(parser, reply.bytes);
        ASSERT_EQ(events.size(), 1U) << reply.bytes;
        EXPECT_EQ(events[0].event.kind, ALE_SCIP_REPLY);
        EXPECT_STREQ(events[0].event.echo, reply.echo);
        EXPECT_STREQ(events[0].event.status, reply.status);
        EXPECT_EQ(events[0].event.protocol, reply.protocol);
    }
    EXPECT_EQ(counters().garbage_bytes, 0U);
}

TEST_F(ScipParse, information_lines_come_one_by_one_with_their_sums_judged)
{
    const std::vector<Parsed> events =
        parse_into(parser, "VV\n00P\nPROT:SCIP 2.0;N\nSERI:H0706400;G\nodd\n\n");
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[0].text, "PROT:SCIP 2.0");
    EXPECT_TRUE(events[0].event.sum_right);
    EXPECT_EQ(events[1].text, "SERI:H0706400");
    EXPECT_FALSE(events[1].event.sum_right);
    EXPECT_FALSE(events[2].event.sum_right);
    EXPECT_EQ(events[3].event.kind, ALE_SCIP_REPLY);
    EXPECT_EQ(counters().wrong_info_sums, 2U);
}

TEST_F(ScipParse, lines_of_scip_1_have_no_sums)
{
    const std::vector<Parsed> events = parse_into(parser, "V\n0\nVEND:Hokuyo\nSERI:H0508486;\n\n");
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].text, "VEND:Hokuyo");
    EXPECT_EQ(events[1].text, "SERI:H0508486");
    EXPECT_TRUE(events[1].event.sum_right);
}

TEST_F(ScipParse, sensor_time_of_tm_is_a_line)
{
    const std::vector<Parsed> events = parse_into(parser, "TM1\n00P\nm2@0?\n\n");
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].text, "m2@0");
    EXPECT_TRUE(events[0].event.sum_right) << "m 2 @ 0: 0x6d+0x32+0x40+0x30 = 0x10f";
}

TEST_F(ScipParse, ranges_of_every_kind_of_request)
{
    const struct {
        const char *echo, *status;
        size_t count;
        unsigned characters;
    } kinds[] = {
        {"GD0044072501", "00", 682, 3},    {"GS0044072501", "00", 682, 2},
        {"MD0044072501000", "99", 682, 3}, {"MS0044072500000", "99", 682, 2},
        {"MD0000076801307", "99", 769, 3}, {"GD0384038400", "00", 1, 3},
        {"MD0044072502000", "99", 341, 3}, {"MS0044072599000", "99", 7, 2},
        {"GD0000006301", "00", 64, 3},     {"MD0044072501000;7", "99", 682, 3},
    };
    for (const auto &kind : kinds) {
        const std::vector<int32_t> values = ramp(kind.count, 20);
        const std::vector<Parsed> events =
            parse_into(parser, frame(kind.echo, kind.status, 0xfffffe, values, kind.characters));
        ASSERT_EQ(events.size(), 1U) << kind.echo;
        EXPECT_EQ(events[0].event.kind, ALE_SCIP_SCAN) << kind.echo;
        EXPECT_EQ(events[0].event.stamp_ms, 0xfffffeU);
        EXPECT_EQ(events[0].values, values);
        EXPECT_TRUE(events[0].event.has_request);
    }
    EXPECT_EQ(counters().garbage_bytes, 0U);
}

TEST_F(ScipParse, ranges_of_scip_1)
{
    const std::vector<int32_t> values = ramp(769, 0);
    const std::string bytes = ale_test::written([&](auto *out) {
        ale_scip_put_echo(out, "G00076801");
        ale_scip_put_status(out, "0");
        ale_scip_put_values(out, ALE_SCIP_1, values.data(), 769, 2);
        ale_scip_put_end(out);
    });
    const std::vector<Parsed> events = parse_into(parser, bytes);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].event.kind, ALE_SCIP_SCAN);
    EXPECT_EQ(events[0].event.protocol, 1);
    EXPECT_FALSE(events[0].event.stamp_known);
    EXPECT_EQ(events[0].values, values);
}

TEST_F(ScipParse, any_cut_into_pieces_reads_the_same)
{
    const std::string bytes = "QT\n00P\n\n" + frame("MD0044072501000", "99", 1, ramp(682, 20), 3) +
                              "VV\n00P\nPROT:SCIP 2.0;N\n\n" +
                              frame("MS0044072501000", "99", 2, ramp(682, 20), 2);
    const std::vector<Parsed> whole = parse(bytes);
    ASSERT_EQ(whole.size(), 5U);
    std::mt19937 random(3);
    for (int round = 0; round < 300; round++) {
        ale_scip_parser_init(&parser);
        std::vector<Parsed> pieces;
        for (size_t at = 0; at < bytes.size();) {
            const size_t count = std::min<size_t>(1 + random() % (round < 100 ? 3 : 900), bytes.size() - at);
            for (Parsed &p : parse_into(parser, bytes.substr(at, count))) {
                pieces.push_back(p);
            }
            at += count;
        }
        ASSERT_EQ(pieces.size(), whole.size());
        for (size_t k = 0; k < whole.size(); k++) {
            EXPECT_EQ(pieces[k].event.kind, whole[k].event.kind);
            EXPECT_EQ(pieces[k].values, whole[k].values);
            EXPECT_EQ(pieces[k].text, whole[k].text);
        }
    }
}

TEST_F(ScipParse, no_single_flipped_bit_passes_for_another_scan)
{
    std::mt19937 random(5);
    std::vector<int32_t> values(682);
    for (int32_t &v : values) {
        v = static_cast<int32_t>(random() % 5600);
    }
    const std::string good = frame("MD0044072501000", "99", 123456, values, 3);
    for (size_t at = 0; at < good.size(); at++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            std::string bytes = good;
            bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << bit));
            for (const Parsed &p : parse(bytes + good)) {
                if (p.event.kind == ALE_SCIP_SCAN) {
                    ASSERT_EQ(p.values, values) << at << " " << bit;
                    ASSERT_EQ(p.event.stamp_ms, 123456U);
                }
            }
        }
    }
}

TEST_F(ScipParse, damage_is_told_apart_and_the_stamp_is_kept)
{
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    std::string wrong_sum = good;
    wrong_sum[300] ^= 1;
    const struct {
        std::string bytes;
        ale_scip_loss_t loss;
        bool stamp_known;
    } cases[] = {
        {wrong_sum, ALE_SCIP_BAD_SUM, true},
        {good.substr(0, 26) + good.substr(26 + 66), ALE_SCIP_BAD_COUNT, true},
        {good.substr(0, 100) + good.substr(101), ALE_SCIP_BAD_SHAPE, true},
        {good.substr(0, 20) + good.substr(26), ALE_SCIP_BAD_SHAPE, false},
        {frame("MX0044072501000", "99", 77, ramp(682, 20), 3), ALE_SCIP_BAD_SHAPE, true},
        {frame("MD0000999901000", "99", 77, ramp(682, 20), 3), ALE_SCIP_BAD_COUNT, true},
    };
    for (const auto &c : cases) {
        const std::vector<Parsed> events = parse(c.bytes + good);
        ASSERT_EQ(events.size(), 2U);
        EXPECT_EQ(events[0].event.kind, ALE_SCIP_LOST);
        if (c.loss != ALE_SCIP_BAD_SHAPE) {
            EXPECT_EQ(events[0].event.loss, c.loss);
        }
        EXPECT_EQ(events[0].event.stamp_known, c.stamp_known);
        EXPECT_EQ(events[1].event.kind, ALE_SCIP_SCAN);
    }
}

TEST_F(ScipParse, characters_outside_the_code_are_refused_even_under_a_right_sum)
{
    std::string line(64, '0');
    line[10] = '0' + 0x40; // 0x70: out of code; adds 0x40, which the six bits of the sum do not see
    const std::string good = frame("GS0000003101", "00", 1, std::vector<int32_t>(32, 0), 2);
    const std::string bytes = good.substr(0, 13 + 4 + 6) + line + good.substr(good.size() - 3);
    const std::vector<Parsed> events = parse(bytes);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].event.kind, ALE_SCIP_LOST);
    EXPECT_EQ(events[0].event.loss, ALE_SCIP_BAD_SHAPE);
}

TEST_F(ScipParse, next_reply_is_found_inside_a_cut_one)
{
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    for (size_t cut = 17; cut < good.size(); cut++) {
        const std::vector<Parsed> events = parse(good.substr(0, cut) + good);
        ASSERT_EQ(events.size(), 2U) << cut;
        EXPECT_EQ(events[0].event.kind, ALE_SCIP_LOST) << cut;
        EXPECT_EQ(events[1].event.kind, ALE_SCIP_SCAN) << cut;
        EXPECT_EQ(events[1].values.size(), 682U);
    }
}

TEST_F(ScipParse, garbage_without_end_is_dropped_and_counted_and_the_echo_behind_it_found)
{
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    std::mt19937 random(9);
    for (size_t count : {1U, 80U, 159U, 160U, 161U, 300U, 5000U}) {
        ale_scip_parser_init(&parser);
        std::string garbage;
        while (garbage.size() < count) {
            const char c = static_cast<char>(random());
            garbage += c == '\n' ? '?' : c;
        }
        const std::vector<Parsed> events = parse_into(parser, garbage + good);
        ASSERT_EQ(events.size(), 1U) << count;
        EXPECT_EQ(events[0].event.kind, ALE_SCIP_SCAN);
        EXPECT_EQ(counters().garbage_bytes, count);
    }
}

TEST_F(ScipParse, an_information_line_is_read_up_to_the_longest_line_and_dropped_beyond)
{
    for (const size_t count : {159U, 160U, 161U}) {
        ale_scip_parser_init(&parser);
        const std::string line(count, 'x');
        const std::vector<Parsed> events = parse_into(parser, "VV\n00P\n" + line + "\n\n");
        const bool fits = count <= ALE_SCIP_LINE;
        ASSERT_EQ(events.size(), fits ? 2U : 1U) << count;
        EXPECT_EQ(events.back().event.kind, ALE_SCIP_REPLY);
        EXPECT_EQ(counters().wrong_info_sums, 1U);
        if (fits) {
            EXPECT_EQ(events[0].text, line);
            EXPECT_FALSE(events[0].event.sum_right);
        }
    }
}

TEST_F(ScipParse, random_bytes_never_make_a_scan_and_never_grow)
{
    std::mt19937 random(17);
    std::string noise(2000000, '\0');
    for (char &c : noise) {
        c = random() % 20 == 0 ? '\n' : static_cast<char>(random());
    }
    for (const Parsed &p : parse_into(parser, noise)) {
        EXPECT_NE(p.event.kind, ALE_SCIP_SCAN);
        EXPECT_LE(p.text.size(), static_cast<size_t>(ALE_SCIP_LINE));
    }
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    const std::vector<Parsed> events = parse_into(parser, "\n\n" + good);
    EXPECT_EQ(events.back().event.kind, ALE_SCIP_SCAN);
}

TEST_F(ScipParse, arrival_is_that_of_the_first_and_the_last_byte)
{
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    parse_into(parser, good, 100);
    parse_into(parser, good.substr(0, 5), 200);
    parse_into(parser, good.substr(5, 1000), 300);
    const std::vector<Parsed> events = parse_into(parser, good.substr(1005), 400);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].event.first_us, 200);
    EXPECT_EQ(events[0].event.last_us, 400);
}

TEST_F(ScipParse, reset_forgets_half_a_reply_and_keeps_the_counters)
{
    const std::string good = frame("MD0044072501000", "99", 77, ramp(682, 20), 3);
    parse_into(parser, good + good.substr(0, 1000));
    ale_scip_parser_reset(&parser);
    EXPECT_EQ(counters().scans, 1U);
    EXPECT_EQ(parse_into(parser, good).at(0).event.kind, ALE_SCIP_SCAN);
    EXPECT_EQ(counters().lost[ALE_SCIP_CUT], 0U);
}

// What a real URG-04LX (firmware 3.1.04) sent, byte for byte.
TEST_F(ScipParse, dialogue_with_a_real_sensor_is_read_without_a_wrong_sum)
{
    const char *shared = std::getenv("ALE_SHARED");
    if (shared == nullptr || *shared == '\0') {
        GTEST_SKIP() << "needs the recorded dialogue in ../shared/data/urg04lx";
    }
    std::ifstream file(std::string(shared) + "/data/urg04lx/device_reply.logr", std::ios::binary);
    ASSERT_TRUE(file);
    const std::string log((std::istreambuf_iterator<char>(file)), {});
    std::string device;
    std::map<std::string, int> replies;
    std::vector<Parsed> scans;
    for (size_t at = 0; at + 12 <= log.size();) {
        const auto *head = reinterpret_cast<const unsigned char *>(log.data() + at);
        const size_t count = size_t{head[8]} << 24 | size_t{head[9]} << 16 | size_t{head[10]} << 8 | head[11];
        for (const Parsed &p : parse_into(parser, log.substr(at + 12, count))) {
            if (p.event.kind == ALE_SCIP_LINE_READ) {
                EXPECT_TRUE(p.event.sum_right) << p.text;
            } else if (p.event.kind == ALE_SCIP_SCAN) {
                scans.push_back(p);
            } else {
                EXPECT_EQ(p.event.kind, ALE_SCIP_REPLY);
                replies[std::string(p.event.echo) + " " + p.event.status]++;
            }
        }
        device += log.substr(at + 12, count);
        at += 12 + count;
    }
    EXPECT_EQ(counters().garbage_bytes, 0U);
    EXPECT_EQ(counters().wrong_info_sums, 0U);
    EXPECT_GT(replies["VV 00"], 1);
    EXPECT_GT(replies["PP 00"], 1);
    EXPECT_EQ(replies["BM 02"], 1);
    ASSERT_FALSE(scans.empty());
    const Parsed &full = scans[0];
    ASSERT_EQ(full.values.size(), 682U);
    // Counted by others in this scan: 94 zeros, six sevens, one ten; valid ranges from 76 to 4166 mm.
    EXPECT_EQ(std::count(full.values.begin(), full.values.end(), 0), 94);
    EXPECT_EQ(std::count(full.values.begin(), full.values.end(), 7), 6);
    EXPECT_EQ(std::count(full.values.begin(), full.values.end(), 10), 1);
    int32_t least = 1 << 20;
    int32_t most = 0;
    for (const int32_t v : full.values) {
        least = v >= 20 ? std::min(least, v) : least;
        most = std::max(most, v);
    }
    EXPECT_EQ(least, 76);
    EXPECT_EQ(most, 4166);

    // The encoder writes the very bytes of the sensor.
    const std::string again = frame(full.event.echo, full.event.status, full.event.stamp_ms, full.values, 3);
    EXPECT_NE(device.find(again), std::string::npos);
}

} // namespace
