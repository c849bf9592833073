#include "operator/console/recordings/wanted.h"

#include "operator/console/recordings/map_copy.h"

namespace console
{

std::optional<Wanted> wanted_of(std::string_view path)
{
    const size_t slash = path.find('/', 1);
    const size_t dot = path.rfind('.');
    if (slash == std::string_view::npos || dot == std::string_view::npos || dot <= slash + 1) {
        return std::nullopt;
    }
    const std::string_view folder = path.substr(1, slash - 1);
    const std::string stem(path.substr(slash + 1, dot - slash - 1));
    const std::string ending(path.substr(dot + 1));
    using Kind = Wanted::Kind;
    if (folder == "recordings" && ending == "lcm") {
        return Wanted{Kind::recording, stem, ending};
    }
    if (!is_map_ending(ending)) {
        return std::nullopt;
    }
    if (folder == "recordings") {
        return Wanted{Kind::recorded_map, stem, ending};
    }
    if (folder == "maps") {
        return Wanted{Kind::saved_map, stem, ending};
    }
    return folder == "live" && stem == "map" ? std::optional(Wanted{Kind::live_map, stem, ending})
                                             : std::nullopt;
}

} // namespace console
