#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <string>

#include "files.hpp"

extern "C" {
#include "base/trig.h"
#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_model.h"
#include "config/decimal.h"
#include "config/presets.h"
}

namespace
{

std::string print(const ale_config_t &config)
{
    char *text = nullptr;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    ale_config_print(&config, out);
    fclose(out);
    std::string result(text, size);
    free(text);
    return result;
}

/* Empty when the text was taken, else the message. */
std::string parse(const std::string &text, ale_config_t &config)
{
    ale_config_error_t error{};
    return ale_config_parse(text.c_str(), "robot.ini", &config, &error) == 0 ? "" : error.message;
}

std::string refusal(const std::string &text)
{
    ale_config_t config = ale_config_default();
    const std::string before = print(config);
    const std::string message = parse(text, config);
    EXPECT_EQ(print(config), before) << "a refused file must change nothing";
    return message;
}

TEST(Config, EveryKeyIsPrintedWithACommentAndReadsBackTheSame)
{
    const ale_config_t original = ale_config_default();
    const std::string text = print(original);
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const std::string line = std::string(ale_config_keys[k].key) + " = ";
        const bool remark = ale_config_noise_bit(&ale_config_keys[k]) != 0; // what the preset says
        EXPECT_NE(text.find((remark ? "\n# " : "\n") + line), std::string::npos) << ale_config_keys[k].key;
        EXPECT_GT(std::string(ale_config_keys[k].comment).size(), 5u);
    }
    ale_config_t again{};
    EXPECT_EQ(parse(text, again), "");
    EXPECT_EQ(print(again), text);
    EXPECT_EQ(again.pipeline.max_speed_mm_s, original.pipeline.max_speed_mm_s);
    EXPECT_EQ(again.pipeline.extract.noise.bearing_nrad, original.pipeline.extract.noise.bearing_nrad);
}

TEST(Config, ValuesReachTheirFieldsInIntegerUnits)
{
    ale_config_t config = ale_config_default();
    EXPECT_EQ(parse("[sensor]\nport = /dev/ttyUSB3\nserial=H0508486\nx = 0.145\ny=-0.02\ntheta = "
                    "1.5707963268\nreversed = yes\n"
                    "blind = -120:-100, 100 : 120\nfirst_step=44\nlast_step=725\n[noise]\nown_um = "
                    "1700\n[extract]\nmin_length = 0.25\n"
                    "smooth_span = 9\n[odometry]\nuse=no\nlag_us = 155000\nscale = 0.03\n[robot]\nmax_speed "
                    "= 0.8\nwidth = 0.52\nmargin = 0.05\ndeceleration = 0.7\nreaction = 0.3\nblind_speed = "
                    "0.15\n[explore]\nspeed = 0.35\nturn_rate = 0.6\nclearance = 0.08\n[lcm]\n"
                    "url = udpm://239.255.76.67:7700?ttl=0\npublish_scan = "
                    "true\n[realtime]\npriority=0\ncpu=1\nlock_memory=no\n"
                    "[map]\nfile = home.map\n",
                    config),
              "");
    EXPECT_STREQ(config.port, "/dev/ttyUSB3");
    EXPECT_STREQ(config.serial, "H0508486");
    EXPECT_EQ(config.pipeline.sensor.x_um, 145000);
    EXPECT_EQ(config.pipeline.sensor.y_um, -20000);
    EXPECT_NEAR(static_cast<double>(config.pipeline.sensor.theta_bam), ALE_BAM_QUARTER_TURN, 1);
    EXPECT_TRUE(config.reversed);
    ASSERT_EQ(config.pipeline.blind_count, 2u);
    EXPECT_NEAR(static_cast<double>(static_cast<int32_t>(config.pipeline.blind[0].from_bam)),
                -std::ldexp(1, 32) / 3, 1);
    EXPECT_NEAR(static_cast<double>(config.pipeline.blind[1].to_bam), std::ldexp(1, 32) / 3, 1);
    EXPECT_EQ(config.first_step, 44);
    EXPECT_EQ(config.last_step, 725);
    EXPECT_EQ(config.pipeline.extract.noise.own_um, 1700);
    EXPECT_EQ(config.pipeline.extract.min_length_um, 250000);
    EXPECT_EQ(config.pipeline.extract.smooth_span, 9);
    EXPECT_FALSE(config.pipeline.use_odometry);
    EXPECT_EQ(config.pipeline.odometry_lag_us, 155000);
    EXPECT_EQ(config.pipeline.odometry_scale_ppm, 30000);
    EXPECT_EQ(config.pipeline.max_speed_mm_s, 800);
    EXPECT_EQ(config.robot.width_um, 520000);
    EXPECT_EQ(config.robot.margin_um, 50000);
    EXPECT_EQ(config.robot.deceleration_um_s2, 700000);
    EXPECT_EQ(config.robot.reaction_us, 300000);
    EXPECT_EQ(config.robot.blind_um_s, 150000);
    const ale_explorer_config_t explorer = ale_config_explorer(&config);
    EXPECT_EQ(explorer.follower.shape.width_um, 520000);
    EXPECT_EQ(explorer.follower.sensor.x_um, 145000);
    EXPECT_EQ(explorer.follower.speed_um_s, 350000);
    EXPECT_EQ(explorer.follower.turn_urad_s, 600000);
    EXPECT_EQ(explorer.clearance_um, 80000);
    EXPECT_STREQ(config.lcm_url, "udpm://239.255.76.67:7700?ttl=0");
    EXPECT_TRUE(config.publish_scan);
    EXPECT_EQ(config.priority, 0);
    EXPECT_EQ(config.cpu, 1);
    EXPECT_FALSE(config.lock_memory);
    EXPECT_STREQ(config.map, "home.map");
}

TEST(Config, AnglesPrintShortAndReadBackExactly)
{
    std::mt19937 random(2);
    for (int k = 0; k < 5000; k++) {
        ale_config_t config = ale_config_default();
        config.pipeline.sensor.theta_bam = static_cast<uint32_t>(random());
        config.pipeline.blind_count = 1;
        config.pipeline.blind[0] = {static_cast<uint32_t>(random()), static_cast<uint32_t>(random())};
        ale_config_t again = ale_config_default();
        ASSERT_EQ(parse(print(config), again), "");
        ASSERT_EQ(again.pipeline.sensor.theta_bam, config.pipeline.sensor.theta_bam);
        ASSERT_EQ(again.pipeline.blind[0].from_bam, config.pipeline.blind[0].from_bam);
        ASSERT_EQ(again.pipeline.blind[0].to_bam, config.pipeline.blind[0].to_bam);
    }
    ale_config_t config = ale_config_default();
    ASSERT_EQ(parse("[sensor]\ntheta = 0.3\nblind = 60:90.5", config), "");
    EXPECT_NE(print(config).find("theta = 0.3\n"), std::string::npos);
    EXPECT_NE(print(config).find("blind = 60:90.5\n"), std::string::npos);
}

TEST(Config, AModelSaysTheNoiseButForWhatIsSet)
{
    for (const char *text : {"[sensor]\nmodel = ld06\n[noise]\nown_um = 8000\n",
                             "[noise]\nown_um = 8000\n[sensor]\nmodel = ld06\n"}) {
        ale_config_t config = ale_config_default();
        ASSERT_EQ(parse(text, config), "");
        EXPECT_EQ(config.pipeline.extract.noise.own_um, 8000);
        EXPECT_EQ(config.pipeline.extract.noise.own_ppm, 0);
        EXPECT_EQ(config.pipeline.extract.noise.bearing_nrad, 1745329);
        EXPECT_TRUE(ale_config_use_preset(&config, "rplidar-a1"));
        EXPECT_EQ(config.pipeline.extract.noise.own_um, 8000) << "what is set stays";
        EXPECT_EQ(config.pipeline.extract.noise.own_ppm_per_m, 2200);
        EXPECT_FALSE(ale_config_use_preset(&config, "ld07"));
        ale_config_t again = ale_config_default();
        ASSERT_EQ(parse(print(config), again), "");
        EXPECT_EQ(print(again), print(config));
    }
}

TEST(Config, ATypeWithoutAModelHasTheUsualNoiseOfItsFamily)
{
    ale_config_t config = ale_config_default();
    ASSERT_EQ(parse("[sensor]\ntype = ldrobot\n", config), "");
    EXPECT_EQ(config.pipeline.extract.noise.own_um, 10000);
    ASSERT_EQ(parse("[sensor]\ntype = urg\n", config), "");
    EXPECT_EQ(config.pipeline.extract.noise.own_um, 1500);
    config.pipeline.extract.noise.own_um = 3;
    ASSERT_EQ(parse("[sensor]\nport = x\n", config), "");
    EXPECT_EQ(config.pipeline.extract.noise.own_um, 3) << "nothing is said of the scanner";
}

TEST(Config, AFileMadeOfWhatIsPrintedFollowsAnotherModel)
{
    std::string text = print(ale_config_default());
    text.replace(text.find("model = "), 8, "model = ld19");
    ale_config_t config = ale_config_default();
    ASSERT_EQ(parse(text, config), "");
    EXPECT_EQ(config.pipeline.extract.noise.own_um, 10000);
}

TEST(Config, AModelThatIsNoneIsToldThoseThatAre)
{
    char names[ALE_PRESET_NAMES];
    ale_preset_names(names);
    EXPECT_EQ(refusal("[sensor]\n\nmodel = ld07\n"),
              std::string("robot.ini:3: sensor.model: ld07 is none of ") + names);
    for (size_t k = 0; k < ale_config_key_count; k++) {
        if (std::string(ale_config_keys[k].key) == "model") {
            std::string comment = ale_config_keys[k].comment;
            comment.replace(comment.find('\n'), 1, " ");
            EXPECT_NE(comment.find(names), std::string::npos) << "the remark lists them all";
        }
    }
}

TEST(Config, LinesNotGivenKeepTheirValue)
{
    ale_config_t config = ale_config_default();
    config.baud = 115200;
    EXPECT_EQ(parse("; nothing here\n\n[robot]\n   max_turn = 1.5 ; indented, with a remark\n", config), "");
    EXPECT_EQ(config.baud, 115200);
    EXPECT_EQ(config.pipeline.max_turn_mrad_s, 1500);
    EXPECT_EQ(parse("", config), "");
}

TEST(Config, ErrorsNameFileLineAndKey)
{
    EXPECT_EQ(refusal("[sensor]\n\ntheta = 9.5\n"),
              "robot.ini:3: sensor.theta: 9.5 is not a number from -3.141592653 to 3.141592653");
    EXPECT_EQ(refusal("[sensor]\nthetta = 1\n"), "robot.ini:2: sensor.thetta: no such key");
    EXPECT_EQ(refusal("[censor]\ntheta = 1\n"), "robot.ini:2: censor.theta: no such key");
    EXPECT_EQ(refusal("[sensor]\nx = 1\n x = 2\n"), "robot.ini:3: sensor.x: given twice");
    EXPECT_EQ(refusal("[sensor]\nreversed = maybe\n"),
              "robot.ini:2: sensor.reversed: maybe is neither yes nor no");
    EXPECT_EQ(refusal("[extract]\nsmooth_span = 10\n"),
              "robot.ini:2: extract.smooth_span: 10 is not a number from 1 to 31, odd");
    EXPECT_EQ(refusal("[sensor]\ntype = sick\n"),
              "robot.ini:2: sensor.type: sick is none of urg, ldrobot, rplidar, auto");
    EXPECT_EQ(refusal("[sensor]\nblind = 10\n"),
              "robot.ini:2: sensor.blind: a sector is from:to in degrees, -360 to 360");
    EXPECT_EQ(refusal("[sensor]\nblind = 1:2,1:2,1:2,1:2,1:2,1:2,1:2,1:2,1:2\n"),
              "robot.ini:2: sensor.blind: more than 8 sectors");
    EXPECT_EQ(refusal("[sensor]\nfirst_step = 50\nlast_step = 40\n"),
              "robot.ini:3: sensor.last_step: 40 is below sensor.first_step 50");
    EXPECT_EQ(refusal("[sensor]\nnonsense\nx = 100\n"),
              "robot.ini:2: neither [section], key = value, nor comment");
    EXPECT_EQ(refusal("[sensor]\nx = 100\nnonsense\n"),
              "robot.ini:2: sensor.x: 100 is not a number from -10 to 10");
    EXPECT_EQ(refusal("[sensor]\nport = " + std::string(300, 'p') + "\n"),
              "robot.ini:2: longer than 198 characters");
    EXPECT_EQ(refusal("[sensor]\nserial = " + std::string(50, 's') + "\n"),
              "robot.ini:2: sensor.serial: longer than 39 characters");
}

TEST(Config, EveryNumberRefusesWhatLiesBeyondItsRange)
{
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const ale_config_key_t &key = ale_config_keys[k];
        if (key.kind != ALE_KEY_NUMBER && key.kind != ALE_KEY_ODD && key.kind != ALE_KEY_ANGLE) {
            continue;
        }
        const double scale = std::pow(10, key.digits);
        for (const double bad :
             {static_cast<double>(key.min) / scale - 1, static_cast<double>(key.max) / scale + 1}) {
            const std::string text =
                std::string("[") + key.section + "]\n" + key.key + " = " + std::to_string(bad);
            EXPECT_NE(refusal(text).find(std::string(key.section) + "." + key.key), std::string::npos)
                << text;
        }
    }
}

/* The table's ranges are those of the core: what the configuration takes, the core takes. */
TEST(Config, TheCoreAcceptsBothEndsOfEveryRange)
{
    const auto memory = std::make_unique<uint8_t[]>(ale_pipeline_size());
    auto *pipeline = reinterpret_cast<ale_pipeline_t *>(memory.get());
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const ale_config_key_t &key = ale_config_keys[k];
        for (const int64_t end : {key.min, key.max}) {
            char text[ALE_DECIMAL_TEXT];
            ale_decimal_print(end, key.digits, text);
            ale_config_t config = ale_config_default();
            const bool is_number =
                key.kind == ALE_KEY_NUMBER || key.kind == ALE_KEY_ODD || key.kind == ALE_KEY_ANGLE;
            if (is_number && std::string(key.key) != "first_step") {
                ASSERT_EQ(parse(std::string("[") + key.section + "]\n" + key.key + " = " + text, config), "");
                EXPECT_EQ(ale_pipeline_init(pipeline, &config.pipeline), 0)
                    << key.section << "." << key.key << " = " << text;
            }
        }
    }
}

TEST(Config, AMissingFileIsNamed)
{
    ale_config_t config = ale_config_default();
    ale_config_error_t error{};
    EXPECT_EQ(ale_config_load("/no/such/file.ini", &config, &error), -1);
    EXPECT_STREQ(error.message, "/no/such/file.ini: No such file or directory");
    EXPECT_EQ(ale_config_load("/", &config, &error), -1);
    EXPECT_STREQ(error.message, "/: is a directory");
}

TEST(Config, WhatIsNoTextIsCalledSoAndNotRepeated)
{
    ale_config_t config = ale_config_default();
    EXPECT_EQ(parse("[robot]\nmax\x01\x1b[2Jspeed = 3\n", config),
              "robot.ini:2: holds control characters: this is no text");
}

TEST(Config, AFileReadsLikeItsText)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "robot.ini";
    std::ofstream(path) << "[robot]\nmax_speed = 0.4\n";
    ale_config_t config = ale_config_default();
    ale_config_error_t error{};
    EXPECT_EQ(ale_config_load(path.c_str(), &config, &error), 0) << error.message;
    EXPECT_EQ(config.pipeline.max_speed_mm_s, 400);
}

} // namespace
