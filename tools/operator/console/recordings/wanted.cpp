#include "operator/console/recordings/wanted.h"

#include <algorithm>
#include <iterator>

#include "operator/console/recordings/map_copy.h"

namespace console
{

namespace
{

constexpr char any_map[] = "";

/* What lies in which folder of an address. */
constexpr struct {
    std::string_view folder;
    std::string_view ending; /* any_map: one of a map's */
    Wanted::Kind kind;
} kinds[] = {
    {"recordings", "lcm", Wanted::Kind::recording}, {"recordings", any_map, Wanted::Kind::recorded_map},
    {"flights", "scip", Wanted::Kind::flight},      {"flights", any_map, Wanted::Kind::flight_map},
    {"maps", any_map, Wanted::Kind::saved_map},     {"live", any_map, Wanted::Kind::live_map}};

} // namespace

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
    const auto *found = std::find_if(std::begin(kinds), std::end(kinds), [&](const auto &kind) {
        return kind.folder == folder &&
               (kind.ending == any_map ? is_map_ending(ending) : kind.ending == ending);
    });
    const bool is_one = found != std::end(kinds) && (found->kind != Wanted::Kind::live_map || stem == "map");
    return is_one ? std::optional(Wanted{found->kind, stem, ending}) : std::nullopt;
}

} // namespace console
