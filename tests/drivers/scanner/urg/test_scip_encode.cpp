#include <gtest/gtest.h>

#include "drivers/scanner/urg/scip_text.hpp"

extern "C" {
#include "scanner/urg/scip_code.h"
}

using ale_test::written;

namespace
{

std::string encoded(uint32_t value, unsigned characters)
{
    std::string out(characters, '?');
    ale_scip_encode(value, characters, reinterpret_cast<uint8_t *>(out.data()));
    return out;
}

TEST(ScipCode, numbers_of_the_specification_are_coded_as_it_shows_them)
{
    EXPECT_EQ(encoded(1234, 2), "CB");
    EXPECT_EQ(encoded(5432, 3), "1Dh");
    EXPECT_EQ(encoded(16000000, 4), "m2@0");
    EXPECT_EQ(encoded(19, 2), "0C");
}

TEST(ScipCode, every_number_survives_coding_and_decoding)
{
    for (unsigned characters = 1; characters <= 4; characters++) {
        const uint32_t end = 1U << (6 * characters);
        for (uint32_t v = 0; v < end; v += characters < 4 ? 1 : 4099) {
            const std::string text = encoded(v, characters);
            ASSERT_EQ(ale_scip_decode(reinterpret_cast<const uint8_t *>(text.data()), characters),
                      static_cast<int32_t>(v));
        }
    }
}

TEST(ScipCode, characters_outside_the_code_are_refused)
{
    for (int c = 0; c < 256; c++) {
        const uint8_t pair[] = {'0', static_cast<uint8_t>(c)};
        EXPECT_EQ(ale_scip_decode(pair, 2) >= 0, c >= 0x30 && c <= 0x6f) << c;
    }
}

TEST(ScipEncode, status_lines_carry_the_sums_of_the_specification)
{
    const std::pair<const char *, const char *> lines[] = {
        {"00", "00P\n"}, {"99", "99b\n"}, {"02", "02R\n"}, {"03", "03S\n"}, {"01", "01Q\n"},
        {"10", "10Q\n"}, {"0E", "0Ee\n"}, {"0D", "0Dd\n"}, {"0", "0\n"},    {"E", "E\n"},
    };
    for (const auto &[status, line] : lines) {
        EXPECT_EQ(written([&, s = status](auto *out) { ale_scip_put_status(out, s); }), line);
    }
}

TEST(ScipEncode, information_lines_leave_the_semicolon_out_of_the_sum)
{
    // All of them as a real URG-04LX sent them.
    const char *const lines[][3] = {
        {"VEND", "Hokuyo Automatic Co.,Ltd.", "VEND:Hokuyo Automatic Co.,Ltd.;[\n"},
        {"PROD", "SOKUIKI Sensor URG-04LX", "PROD:SOKUIKI Sensor URG-04LX;[\n"},
        {"FIRM", "3.1.04(02/Aug./2007)", "FIRM:3.1.04(02/Aug./2007);a\n"},
        {"ARES", "1024", "ARES:1024;\\\n"},
        {"TIME", "6A5404", "TIME:6A5404;]\n"},
        {"STAT", "Sensor works well.", "STAT:Sensor works well.;8\n"},
    };
    for (const auto &line : lines) {
        EXPECT_EQ(written([&](auto *out) { ale_scip_put_info(out, line[0], line[1]); }), line[2]);
    }
}

TEST(ScipEncode, data_is_cut_in_lines_of_64_and_a_value_may_be_cut_by_a_line_end)
{
    const std::vector<int32_t> values(682, 1234);
    const std::string bytes = ale_test::frame("MD0044072501000", "99", 5, values, 3);
    EXPECT_EQ(bytes.size(), 2137U) << "the length of a real frame";
    EXPECT_EQ(ale_test::frame("GD0044072501", "00", 5, values, 3).size(), 2134U);
    EXPECT_EQ(bytes.substr(16, 4), "99b\n");
    EXPECT_EQ(bytes[26 + 65], '\n');
    EXPECT_EQ(bytes.substr(bytes.size() - 2), "\n\n");
}

TEST(ScipEncode, full_lines_alone_leave_no_empty_last_line)
{
    const std::vector<int32_t> values(64, 0);
    const std::string bytes = ale_test::frame("GD0000006301", "00", 0, values, 3);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), '\n'), 3 + 3 + 1);
}

TEST(ScipEncode, scip_1_data_has_no_sums)
{
    const std::vector<int32_t> values(769, 19);
    const std::string bytes =
        written([&](auto *out) { ale_scip_put_values(out, ALE_SCIP_1, values.data(), 769, 2); });
    EXPECT_EQ(bytes.size(), 1538U + 25U);
    EXPECT_EQ(bytes.substr(0, 88),
              std::string("0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C0C\n"
                          "0C0C0C0C0C0C0C0C0C0C0C0")
                  .substr(0, 88));
}

TEST(ScipEncode, values_saturate_at_what_the_characters_hold)
{
    const int32_t values[] = {-5, 4095, 5000, 300000};
    EXPECT_EQ(written([&](auto *out) { ale_scip_put_values(out, ALE_SCIP_1, values, 3, 2); }), "00oooo\n");
    EXPECT_EQ(written([&](auto *out) { ale_scip_put_values(out, ALE_SCIP_1, values + 3, 1, 3); }), "ooo\n");
}

TEST(ScipEncode, what_does_not_fit_is_left_out_whole)
{
    uint8_t bytes[8];
    ale_scip_writer_t out = {bytes, sizeof bytes, 0, false};
    ale_scip_put_echo(&out, "QT");
    EXPECT_FALSE(out.overflow);
    ale_scip_put_info(&out, "STAT", "too long");
    EXPECT_TRUE(out.overflow);
    ale_scip_put_end(&out);
    EXPECT_EQ(out.used, 3U);
}

TEST(ScipRequest, text_and_fields_say_the_same)
{
    const char *const texts[] = {"GD0044072501",    "GS0000076899", "MD0044072501000",
                                 "MS0128064002305", "G04472501",    "G00076800"};
    for (const char *text : texts) {
        ale_scip_request_t request{};
        ASSERT_TRUE(ale_scip_request_parse(reinterpret_cast<const uint8_t *>(text), strlen(text), &request))
            << text;
        char again[ALE_SCIP_REQUEST_TEXT];
        EXPECT_EQ(ale_scip_request_format(&request, again), strlen(text));
        EXPECT_STREQ(again, text);
    }
}

TEST(ScipRequest, malformed_text_is_refused_and_changes_nothing)
{
    const char *const texts[] = {"",
                                 "G",
                                 "GD004407250",
                                 "GD00440725011",
                                 "GD0044072x01",
                                 "MD0044072501",
                                 "MD004407250100x",
                                 "G0447250",
                                 "G0x472501",
                                 "VV",
                                 "XD0044072501000"};
    for (const char *text : texts) {
        ale_scip_request_t request{};
        request.first_step = 77;
        EXPECT_FALSE(ale_scip_request_parse(reinterpret_cast<const uint8_t *>(text), strlen(text), &request))
            << text;
        EXPECT_EQ(request.first_step, 77);
    }
}

TEST(ScipRequest, values_and_bytes_are_those_of_the_line_budget)
{
    ale_scip_request_t r{};
    r.protocol = 2;
    r.stream = true;
    r.first_step = 44;
    r.last_step = 725;
    const struct {
        uint8_t characters, cluster;
        uint32_t values, bytes;
    } rows[] = {{3, 0, 682, 2137}, {2, 1, 682, 1435}, {3, 2, 341, 1082}, {2, 2, 341, 731}, {3, 3, 228, 733}};
    for (const auto &row : rows) {
        r.characters = row.characters;
        r.cluster = row.cluster;
        EXPECT_EQ(ale_scip_request_values(&r), row.values);
        EXPECT_EQ(ale_scip_request_frame_bytes(&r), row.bytes);
    }
    r.last_step = 43;
    EXPECT_EQ(ale_scip_request_values(&r), 0U);
}

} // namespace
