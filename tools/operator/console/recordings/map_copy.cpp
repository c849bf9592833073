#include "operator/console/recordings/map_copy.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "operator/console/recordings/zip.h"

namespace console
{

namespace
{

/* A folder of its own that goes when it is no longer wanted: maps are written as files. */
class Workplace
{
  public:
    Workplace()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "ale-console-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) {
            throw std::runtime_error(pattern + ": " + std::strerror(errno));
        }
        folder_ = pattern;
    }
    ~Workplace()
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    Workplace(const Workplace &) = delete;
    Workplace &operator=(const Workplace &) = delete;

    std::string path(const std::string &name) const
    {
        return (folder_ / name).string();
    }
    std::string content(const std::string &name) const
    {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

  private:
    std::filesystem::path folder_;
};

constexpr std::array<const char *, 5> endings = {"png", "svg", "dxf", "geojson", "zip"};

} // namespace

bool is_map_ending(const std::string &ending)
{
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

std::string map_copy(const ale::MapScene &scene, const std::string &stem, const std::string &ending)
{
    const Workplace workplace;
    const std::string name = stem + (ending == "zip" ? ".pgm" : "." + ending);
    ale::write_map_image(workplace.path(name), scene);
    if (ending != "zip") {
        return workplace.content(name);
    }
    const std::string yaml = stem + ".yaml";
    return zip_of({{name, workplace.content(name)}, {yaml, workplace.content(yaml)}});
}

} // namespace console
