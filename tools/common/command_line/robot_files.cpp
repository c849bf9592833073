#include "common/command_line/robot_files.h"

#include <filesystem>

#include "common/export/map_image.h"

extern "C" {
#include "config/presets.h"
}

namespace cli
{

namespace
{

const std::string &require_map_image(const std::string &path)
{
    if (!ale::is_map_image_name(path)) {
        throw WrongUse("--map " + path + ": there are .png, .svg, .dxf, .pgm, .geojson");
    }
    return path;
}

const std::string &require_svg(const std::string &option, const std::string &path)
{
    const std::string ending = std::filesystem::path(path).extension().string();
    if (!ending.empty() && ending != ".svg") {
        throw WrongUse("--" + option + " " + path + ": there is .svg");
    }
    return path;
}

} // namespace

void load_config(const std::string &path, ale_config_t &config)
{
    ale_config_error_t error;
    if (ale_config_load(path.c_str(), &config, &error) < 0) {
        throw WrongUse(error.message);
    }
}

void scanner_model(CommandLine &line, const std::string &name, std::string &model)
{
    line.option(name, [name, &model](const std::string &word) {
        ale_noise_t noise;
        if (!ale_preset_noise(word.c_str(), &noise)) {
            char names[ALE_PRESET_NAMES];
            ale_preset_names(names);
            throw WrongUse("--" + name + " " + word + ": there are " + names);
        }
        model = word;
    });
}

void map_image(CommandLine &line, std::string &path)
{
    line.option("map", [&path](const std::string &word) { path = require_map_image(word); });
}

void map_images(CommandLine &line, std::vector<std::string> &paths)
{
    line.option("map", [&paths](const std::string &word) { paths.push_back(require_map_image(word)); });
}

void drawing(CommandLine &line, const std::string &name, std::string &path)
{
    line.option(name, [name, &path](const std::string &word) { path = require_svg(name, word); });
}

} // namespace cli
