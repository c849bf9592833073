// The presets of scanners, as compiled in and as their file says.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

extern "C" {
#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_model.h"
#include "config/presets.h"
#include "extract/extract.h"
}

namespace
{

struct Preset {
    std::string name;
    std::string source; // the remark under its name
    std::map<std::string, std::string> values;
};

std::vector<Preset> presets()
{
    std::vector<Preset> found;
    std::ifstream file("firmware/config/scanners.ini");
    for (std::string line; std::getline(file, line);) {
        std::smatch parts;
        if (std::regex_match(line, parts, std::regex(R"(\[(.*)\])"))) {
            found.push_back({parts[1], "", {}});
        } else if (!found.empty() && line.rfind("# ", 0) == 0) {
            found.back().source += line.substr(2) + "\n";
        } else if (std::regex_match(line, parts, std::regex(R"((\w+) = (.*))"))) {
            EXPECT_TRUE(found.back().values.emplace(parts[1], parts[2]).second) << line << ": twice";
        }
    }
    EXPECT_FALSE(found.empty()) << "run from the top of the tree";
    return found;
}

std::string names()
{
    char text[ALE_PRESET_NAMES];
    ale_preset_names(text);
    return text;
}

std::string identified(const char *model)
{
    char name[ALE_PRESET_NAME] = "nothing";
    return ale_preset_identify(model, name) ? name : "";
}

ale_noise_t noise_of(const std::string &name)
{
    ale_noise_t noise{};
    EXPECT_TRUE(ale_preset_noise(name.c_str(), &noise)) << name;
    return noise;
}

TEST(Presets, EachSaysWhereItsFiguresAreFromAndWhatTheScannerIs)
{
    std::string listed;
    for (const Preset &preset : presets()) {
        listed += (listed.empty() ? "" : ", ") + preset.name;
        EXPECT_LT(preset.name.size(), static_cast<size_t>(ALE_PRESET_NAME));
        EXPECT_GT(preset.source.size(), 30u) << preset.name;
        for (const char *key : {"own_um", "surface_um", "range_min", "range_max", "beams", "beams_a_turn",
                                "first_degrees", "turn_s"}) {
            EXPECT_EQ(preset.values.count(key), 1u) << preset.name << ": " << key;
        }
    }
    EXPECT_EQ(names(), listed);
}

TEST(Presets, EveryNoiseIsOneThatTheExtractorTakes)
{
    for (const Preset &preset : presets()) {
        ale_config_t config = ale_config_default();
        ASSERT_TRUE(ale_config_use_preset(&config, preset.name.c_str()));
        std::vector<char> memory(ale_extractor_size());
        auto *extractor = reinterpret_cast<ale_extractor_t *>(memory.data());
        EXPECT_EQ(ale_extractor_init(extractor, &config.pipeline.extract), 0) << preset.name;
        for (const auto &[key, value] : preset.values) {
            if (const ale_config_key_t *entry = ale_config_key("noise", key.c_str())) {
                const auto *field = reinterpret_cast<const char *>(&config) + entry->offset;
                EXPECT_EQ(*reinterpret_cast<const int32_t *>(field), std::stoi(value))
                    << preset.name << ": " << key;
            }
        }
    }
}

TEST(Presets, TheUrgsIsTheDefault)
{
    const ale_noise_t urg = noise_of("urg-04lx");
    const ale_noise_t usual = ale_noise_default();
    EXPECT_EQ(urg.own_um, usual.own_um);
    EXPECT_EQ(urg.own_ppm, usual.own_ppm);
    EXPECT_EQ(urg.own_ppm_per_m, usual.own_ppm_per_m);
    EXPECT_EQ(urg.shared_um, usual.shared_um);
    EXPECT_EQ(urg.shared_ppm, usual.shared_ppm);
    EXPECT_EQ(urg.shared_beams, usual.shared_beams);
    EXPECT_EQ(urg.surface_um, usual.surface_um);
    EXPECT_EQ(urg.bearing_nrad, usual.bearing_nrad);
}

TEST(Presets, AScannerIsKnownByWhatItTells)
{
    EXPECT_EQ(identified("URG-04LX(Hokuyo Automatic Co.,Ltd.)"), "urg-04lx");
    EXPECT_EQ(identified("UTM-30LX[Hokuyo Automatic Co.,Ltd.]"), "utm-30lx");
    EXPECT_EQ(identified("UTM-30LX-EW[Hokuyo Automatic Co.,Ltd.]"), "utm-30lx-ew") << "the longest that fits";
    EXPECT_EQ(identified("UST-20LX"), "ust-10lx");
    EXPECT_EQ(identified("LDROBOT LD06, LD19 or STL-19P"), "ld06");
    EXPECT_EQ(identified("RPLIDAR C1M1"), "rplidar-c1");
    EXPECT_EQ(identified("RPLIDAR S3M1"), "rplidar-a1") << "one without a preset: the roughest of the family";
    EXPECT_EQ(identified("Recorded scanner"), "");
    EXPECT_EQ(identified(""), "");
}

TEST(Presets, NobodyIsCalledSo)
{
    ale_noise_t noise{};
    noise.own_um = 7;
    EXPECT_FALSE(ale_preset_noise("ld07", &noise));
    EXPECT_FALSE(ale_preset_noise("", &noise));
    EXPECT_EQ(noise.own_um, 7);
}

TEST(Presets, TheConfiguredOneGoesBeforeTheOneThatIsKnownAndThatBeforeTheUsualOne)
{
    ale_config_t config = ale_config_default();
    char name[ALE_PRESET_NAME];
    ale_config_preset(&config, "", name);
    EXPECT_STREQ(name, "urg-04lx");
    snprintf(config.type, sizeof config.type, "rplidar");
    ale_config_preset(&config, "", name);
    EXPECT_STREQ(name, "rplidar-a1");
    ale_config_preset(&config, "RPLIDAR S2M1", name);
    EXPECT_STREQ(name, "rplidar-s2");
    snprintf(config.model, sizeof config.model, "ld19");
    ale_config_preset(&config, "RPLIDAR S2M1", name);
    EXPECT_STREQ(name, "ld19");
}

} // namespace
