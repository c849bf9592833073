// drivers/scanner/urg/stranger: what speaks on a port where no URG answers.
#include <random>
#include <string>

#include <gtest/gtest.h>

extern "C" {
#include "scanner/urg/stranger.h"
}

namespace
{

const std::string gps = "$GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,*76\r\n";

std::string noise(unsigned seed, size_t count)
{
    std::mt19937 random(seed);
    std::string bytes;
    while (bytes.size() < count) {
        bytes += static_cast<char>(random() & 0xff);
    }
    return bytes;
}

// A measurement as the protocol of the RPLIDAR describes it: quality and start, inverted start; angle and
// check bit; range.
std::string nodes(unsigned seed, size_t count)
{
    std::mt19937 random(seed);
    std::string bytes;
    for (size_t n = 0; n < count; n++) {
        const unsigned start = n % 360 == 0 ? 1 : 0;
        const unsigned quality = random() % 64;
        const unsigned angle = static_cast<unsigned>(n % 360) * 64;
        bytes += static_cast<char>(quality << 2 | (1 - start) << 1 | start);
        bytes += static_cast<char>((angle << 1 & 0xfe) | 1);
        bytes += static_cast<char>(angle >> 7 & 0xff);
        bytes += static_cast<char>(random() & 0xff);
        bytes += static_cast<char>(random() & 0x3f);
    }
    return bytes;
}

std::string heard(const std::string &bytes, size_t piece = 7)
{
    ale_stranger_t stranger = {};
    for (size_t at = 0; at < bytes.size(); at += piece) {
        const std::string part = bytes.substr(at, piece);
        ale_stranger_hear(&stranger, reinterpret_cast<const uint8_t *>(part.data()),
                          static_cast<uint32_t>(part.size()));
    }
    ale_stranger_judge(&stranger);
    char words[ALE_STRANGER_WORDS];
    ale_stranger_words(&stranger, words);
    for (const char *c = words; *c != '\0'; c++) {
        EXPECT_TRUE(*c >= ' ' && *c <= '~') << static_cast<int>(*c);
    }
    return words;
}

TEST(Stranger, silence_is_called_that)
{
    EXPECT_EQ(heard(""), "not a byte comes from it");
}

TEST(Stranger, nmea_is_known_wherever_one_begins_to_listen)
{
    for (size_t begin = 0; begin < gps.size(); begin++) {
        EXPECT_NE(heard((gps + gps + gps).substr(begin)).find("NMEA"), std::string::npos) << begin;
    }
    EXPECT_EQ(heard(gps), "what speaks there is NMEA, as of a GPS receiver: $GPGGA,092750.000,5321.6");
}

TEST(Stranger, an_rplidar_is_known_by_what_it_measures_says_or_answers)
{
    for (unsigned seed = 1; seed <= 20; seed++) {
        EXPECT_NE(heard(nodes(seed, 40).substr(seed % 5)).find("RPLIDAR"), std::string::npos) << seed;
    }
    EXPECT_NE(heard("RP LIDAR System.\r\nFirmware Ver 1.29 - 00, HW Ver 7\r\n").find("RPLIDAR"),
              std::string::npos);
    const std::string descriptor("\xa5\x5a\x05\x00\x00\x40\x81", 7);
    EXPECT_NE(heard(descriptor).find("RPLIDAR"), std::string::npos);
}

TEST(Stranger, noise_is_called_nothing_else)
{
    for (unsigned seed = 1; seed <= 2000; seed++) {
        EXPECT_EQ(heard(noise(seed, 1 + seed % 300))
                      .find("bytes come that are nothing known, or of another rate: "),
                  0U)
            << seed;
    }
    EXPECT_EQ(heard(std::string("\x3f\xa2\x00\x10", 4)),
              "bytes come that are nothing known, or of another rate: 3f a2 00 10");
}

TEST(Stranger, text_is_quoted)
{
    EXPECT_EQ(heard("Marlin 2.0.9 ready\r\nok\r\n"), "what speaks there is no URG: Marlin 2.0.9 ready");
}

TEST(Stranger, what_was_understood_at_one_rate_outlasts_noise_at_others)
{
    ale_stranger_t stranger = {};
    for (const std::string &bytes : {noise(1, 100), gps, noise(2, 500), std::string()}) {
        ale_stranger_hear(&stranger, reinterpret_cast<const uint8_t *>(bytes.data()),
                          static_cast<uint32_t>(bytes.size()));
        ale_stranger_judge(&stranger);
    }
    char words[ALE_STRANGER_WORDS];
    ale_stranger_words(&stranger, words);
    EXPECT_NE(std::string(words).find("NMEA"), std::string::npos);
}

} // namespace
