#include "robot/calibrate/configuration.h"

#include <filesystem>
#include <stdexcept>

extern "C" {
#include "config/config.h"
}

namespace calibrate
{

std::string name_of_log(const std::string &path)
{
    constexpr size_t longest = 60;
    std::string name = std::filesystem::path(path).filename().string();
    if (name.size() > longest) {
        name.replace(longest - 3, std::string::npos, "...");
    }
    for (char &c : name) {
        c = c < ' ' || c > '~' ? '?' : c;
    }
    return name;
}

std::string accepted(const std::string &configuration)
{
    ale_config_t config = ale_config_default();
    ale_config_error_t error;
    if (ale_config_parse(configuration.c_str(), "text", &config, &error) < 0) {
        const std::string message = error.message; /* "name:line: section.key: ..." */
        throw std::runtime_error("ale-slamd would refuse what was found: " +
                                 message.substr(message.find(": ") + 2));
    }
    return configuration;
}

} // namespace calibrate
